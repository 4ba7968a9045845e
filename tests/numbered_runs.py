"""Runs with numbers of all kinds, for the tests of files of runs."""

import numpy as np
import pytest
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from boreprop.case.case import Case
from boreprop.core.quantities import BY_NAME, OUTPUTS, quantity_of, scalar_names
from boreprop.run.trajectory import Trajectory


def is_integer(scalar_name: str) -> bool:
    return quantity_of(scalar_name).kind == "Integer"


@pytest.fixture
def trajectory(case: Case) -> Trajectory:
    """A run of the paper's case with a number of its own in every cell."""
    columns = {name: np.arange(5) / 7 + k for k, name in enumerate(scalar_names(OUTPUTS, 2))}
    return Trajectory(
        {k: np.array([0.0, 1.0, -1.0, 0.0, 1.0]) if is_integer(k) else v for k, v in columns.items()}, case
    )


@st.composite
def columns(draw: st.DrawFn) -> dict[str, np.ndarray]:
    n, rows = draw(st.integers(1, 6)), draw(st.integers(1, 5))
    numbers = st.floats(allow_nan=False, allow_infinity=False)
    modes = st.sampled_from([-1.0, 0.0, 1.0])
    names = scalar_names((BY_NAME["rss_force"], *OUTPUTS), n)
    return {name: draw(arrays(np.float64, rows, elements=modes if is_integer(name) else numbers)) for name in names}
