"""The ranges of the plots."""

from math import floor, log10

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from boreprop_viz.key import LONGEST, WIDTH, places, shortened, width
from boreprop_viz.scales import MOST_STEPS, plot_range, with_ticks
from boreprop_viz.style import PLOTS

ENDS = st.floats(-1e6, 1e6, allow_subnormal=False)
NAMES = st.lists(st.text("abcdefgh ", min_size=1, max_size=30), min_size=1, max_size=12)


@given(ENDS, ENDS)
def test_two_numbers_of_the_axis_lie_in_the_range_of_a_plot(low: float, high: float) -> None:
    assume(high - low > 1e-6 * max(abs(low), abs(high), 1e-300))
    bottom, top = with_ticks(low, high)
    assert bottom <= low < high <= top
    steps = [10.0**k for k in range(floor(log10(top - bottom)) - 2, floor(log10(top - bottom)) + 1)]
    numbered = next(step for step in steps if (high - low) / step <= MOST_STEPS)  # the viewer takes the finest it can
    clear = 0.09  # steps from the edge, where a number would be cut
    inside = np.arange(np.ceil(bottom / numbered + clear), np.floor(top / numbered - clear) + 1)
    assert len(inside) >= 2
    assert top - bottom <= max(high - low, 2.4 * numbered)


@pytest.mark.parametrize("values", [[3.0, 3.0], [0.0, 0.0], [1e-13, 2e-13], [np.nan, 1.0, 2.0]])
def test_curves_without_a_change_have_a_range_of_round_numbers(values: list[float]) -> None:
    low, high = plot_range(PLOTS["rss_force"], [1000.0 * np.array(values)])
    found = [value for value in values if np.isfinite(value)]
    assert low < min(found) <= max(found) < high
    assert high - low > 1e-3  # of what is rounding the plot shows nothing


@given(NAMES)
def test_the_entries_of_the_key_do_not_cover_each_other(names: list[str]) -> None:
    entries = [(name, (0, 0, 0)) for name in names]
    ends: dict[float, float] = {}
    for (x, y), name in zip(places(entries), names, strict=True):
        assert x >= ends.get(y, 0.0)
        assert x + width(name) <= WIDTH or y not in ends
        ends[y] = x + width(name)


@given(st.text("abc", max_size=300), st.text("abc", max_size=300))
def test_a_name_in_the_key_is_no_wider_than_the_key(beginning: str, end: str) -> None:
    short = shortened(beginning + end)
    assert width(short) <= WIDTH
    assert short.startswith(beginning[: LONGEST // 2])
    assert short.endswith(end[-LONGEST // 2 :])
