"""Axes and distributions as texts of the command line."""

from typing import Any

import numpy as np
import pytest

from boreprop.cli.ranges import parse_axis, parse_distribution, parse_each


def test_an_axis_as_text() -> None:
    axes = parse_each(parse_axis, ["eta_pi=0.1:0.2:3", "stabilizer_clearance[1]=1e-3,2e-3"])
    assert {name: list(axis) for name, axis in axes.items()} == {
        "eta_pi": pytest.approx([0.1, 0.15, 0.2]),
        "stabilizer_clearance[1]": [1e-3, 2e-3],
    }


@pytest.mark.parametrize(
    ("text", "mean", "deviation"),
    [
        ("normal(60e3,6e3)", 60e3, 6e3),
        ("uniform(2, 4)", 3.0, 2 / 12**0.5),
        ("triangular(0,1,2)", 1.0, 1 / 6**0.5),
        ("lognormal(2,0.5)", 2 * np.exp(0.125), 2 * np.exp(0.125) * np.sqrt(np.exp(0.25) - 1)),
    ],
)
def test_a_distribution_as_text(text: str, mean: float, deviation: float) -> None:
    parsed: tuple[str, Any] = parse_distribution(f"eta_pi={text}")
    name, distribution = parsed
    assert name == "eta_pi"
    assert distribution.mean() == pytest.approx(mean)
    assert distribution.std() == pytest.approx(deviation)
