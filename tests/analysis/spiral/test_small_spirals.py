"""Small spirals about a straight vertical hole with a bit that walks."""

from itertools import pairwise
from math import pi, radians

import numpy as np
import pytest

from boreprop.analysis.rippling import longest_wave
from boreprop.analysis.spiral.closed_form import spiral
from boreprop.analysis.spiral.straight import critical, held, rightmost
from boreprop.analysis.spiral.turning import beam_of
from boreprop.analysis.spiral.walking import walk_chart
from boreprop.analysis.stability.roots import critical_eta_pi, find_roots
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from spirals import paper_spiral

BEAM = beam_of(paper_spiral())
TABLE = {  # walk, degrees → critical ηΠ and pitch/ℓ₁ to the right, critical ηΠ to the left, of a program of its own
    0.0: (0.146757, 1.3325, 0.146757),
    5.0: (0.162643, 1.361, 0.131805),
    10.0: (0.179535, 1.392, 0.117728),
    20.0: (0.216691, 1.461, 0.092014),
    30.0: (0.259090, 1.543, 0.069345),
}


@pytest.mark.parametrize("walk_deg", TABLE)
def test_the_critical_eta_pi_is_that_of_the_table(walk_deg: float) -> None:
    right, pitch, left = TABLE[walk_deg]
    longest = longest_wave(paper_case().bha) / paper_case().length_scale
    found = critical(BEAM, radians(walk_deg), longest)
    assert found is not None
    assert found.eta_pi == pytest.approx(right, abs=6e-7)
    assert 2 * pi / found.omega == pytest.approx(pitch, abs=6e-4)
    other = critical(BEAM, -radians(walk_deg), longest)
    assert other is not None
    assert other.eta_pi == pytest.approx(left, abs=6e-7)


def test_without_walk_roots_and_limit_are_those_of_the_plane() -> None:
    case = paper_case()
    planar = find_roots(case, contact=[1], inclination=0.0).roots[0]
    assert rightmost(BEAM, 0.0, 0.01) == pytest.approx(planar)
    found, expected = spiral(case).critical, critical_eta_pi(case, inclination=0.0)
    assert found is not None
    assert expected is not None
    assert found.eta_pi == pytest.approx(expected.eta_pi)
    assert found.wavelength == pytest.approx(expected.wavelength)


@pytest.mark.parametrize("walk", [-0.4, 0.1])
def test_the_rightmost_root_is_a_zero_with_none_beyond_it(walk: float) -> None:
    """The argument principle, by brute force on a fine contour around the upper right."""
    eta_pi = 0.02
    root, function = rightmost(BEAM, walk, eta_pi), held(BEAM, walk)
    value, slope = function(np.array([root]), eta_pi)
    assert abs(value[0] / slope[0]) < 1e-9
    left, right, top, low = root.real + 0.01, 20.0, 600.0, 0.02
    sides = (left + 1j * low, right + 1j * low, right + 1j * top, left + 1j * top, left + 1j * low)
    contour = np.concatenate([np.linspace(a, b, 60_000) for a, b in pairwise(sides)])
    turns = np.angle(function(contour[1:], eta_pi)[0] / function(contour[:-1], eta_pi)[0]).sum() / (2 * pi)
    assert round(float(turns)) == 0


def test_a_chart_has_the_limits_of_each_walk() -> None:
    chart = walk_chart(paper_spiral(), [-0.1, 0.1])
    for k, walk in enumerate(chart.walk_angle):
        found = spiral(paper_spiral(walk_deg=float(np.degrees(walk))), "right")
        assert found.critical is not None
        assert chart.critical_eta_pi[k] == pytest.approx(found.critical.eta_pi)
        assert chart.largest_eta_pi[k] == pytest.approx(found.largest_eta_pi)
    assert (np.diff(chart.largest_eta_pi) > 0).all()


def test_a_chart_of_too_little_weight_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"^eta_pi: must be >= 0.0001, got"):
        walk_chart(paper_spiral(5e-5), [0.0])
