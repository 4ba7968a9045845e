"""BHAs with a near-bit stabilizer, of which it is known what becomes of them over 1500 m: is that what is said?"""

from collections import Counter

import pytest

from boreprop.analysis.rippling import last_wave
from boreprop.analysis.tipping import drill_until_steady
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from near_bit import NEAR_BIT, near_bit_case

pytestmark = pytest.mark.usefixtures("kernel")


def up_to(run: Trajectory, length: float) -> Trajectory:
    drilled = run["drilled_length"] <= length + 1e-6
    return Trajectory({name: column[drilled] for name, column in run.columns.items()}, run.case)


def rippling_at(fate: str, lengths: tuple[float, ...]) -> Counter[float]:
    """How many of the BHAs of a fate are said to ripple after each length."""
    said: Counter[float] = Counter()
    for entry in NEAR_BIT[fate]:
        run = simulate(near_bit_case(entry), sample_interval=0.3, engine="native")
        said.update(length for length in lengths if last_wave(up_to(run, length)).ripples)
    return said


@pytest.mark.slow
def test_those_that_ripple_for_good_are_said_to() -> None:
    said = rippling_at("ripples", (1500.0, 1400.0, 600.0, 300.0))
    assert said[1500.0] >= 135  # one collapses in the last metres: from ±1.06° to ±0.14°
    assert said[1400.0] == said[600.0] == said[300.0] == 136


@pytest.mark.slow
def test_those_that_end_straight_are_said_to_be_straight_once_they_are() -> None:
    said = rippling_at("straight", (1500.0, 600.0, 300.0))
    assert said[1500.0] == 0
    assert said[600.0] <= 6  # waves that last for 100 m and more, and die later
    assert said[300.0] <= 14


@pytest.mark.slow
@pytest.mark.parametrize("fate", ["ripples", "straight"])
def test_an_early_verdict_on_those_in_a_vertical_hole_is_that_of_the_long_run(fate: str) -> None:
    vertical = [entry for entry in NEAR_BIT[fate] if entry["inc"] == 0.0][::2]
    assert len(vertical) > 25
    for entry in vertical:
        assert drill_until_steady(near_bit_case(entry))[1].ripples is (fate == "ripples"), entry
