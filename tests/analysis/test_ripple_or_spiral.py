"""Waves in space: whether they are in a plane or wind, in made-up holes, in drilled ones, and in closed form."""

from dataclasses import dataclass, replace
from math import degrees, pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boreprop.analysis.ellipse import Shape
from boreprop.analysis.rippling import Rippling, find_rippling
from boreprop.analysis.search import State
from boreprop.analysis.space import direction_of
from boreprop.analysis.summary import summarize
from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.errors import MissingColumn
from boreprop.kernel.binding import available
from boreprop.report.tables.summary import lines
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory
from near_bit import NEAR_BIT, near_bit_case
from spirals import disturbed, paper_spiral, trihedron

drills = pytest.mark.skipif(not available(), reason="the kernel is not built")
TO_A_SIDE = (Shape.RIGHT, Shape.LEFT)


# holes that are made up


@dataclass
class Made:
    """A hole whose direction draws an ellipse about a trend that builds and walks, from where it starts to, m."""

    pitch: float = 6.0
    major: float = 1.0  # of the direction, degrees
    ratio: float = 1.0  # minor over major axis, negative to the left
    side: float = 0.5  # of the major axis, rad, from the high side to the right
    inclination: float = 30.0
    build: float = 0.0  # degrees per 30 m
    walk: float = 0.0  # of the azimuth, likewise
    rows: float = 40.0  # a wave
    start: float = 0.0
    noise: float = 0.0  # degrees
    seed: int = 1
    turns: int = 0  # after so many waves the sense changes, again and again; 0: never
    waves: float = 20.0
    uneven: bool = False  # each row is anywhere in its share of the length

    def run(self) -> Trajectory:
        """The rows of the hole, as if of a run."""
        fine, x = 10, np.arange(0.0, self.waves * self.pitch, self.pitch / self.rows / 10)
        inclination = np.radians(self.inclination + self.build * x / 30.0)
        azimuth = 1.0 + np.radians(self.walk * x / 30.0)
        high, right, ahead = trihedron(inclination, azimuth)
        phase = 2 * pi * x / self.pitch + self.seed
        sense = np.where((x / self.pitch) // self.turns % 2, -1.0, 1.0) if self.turns else 1.0
        drawn = np.cos(phase) + 1j * sense * self.ratio * np.sin(phase)
        drawn = radians(self.major) * drawn * np.exp(1j * self.side) * (x >= self.start)
        T = ahead + drawn.real[:, None] * high + drawn.imag[:, None] * right
        T = (T / np.linalg.norm(T, axis=1)[:, None]).T
        position = np.concatenate((np.zeros((3, 1)), np.cumsum((T[:, 1:] + T[:, :-1]) / 2, axis=1)), axis=1) * x[1]
        rng = np.random.default_rng(self.seed)
        rows = np.arange(0, len(x) - fine, fine)
        rows += rng.integers(0, fine, len(rows)) if self.uneven else 0
        steps, x, T, position = np.gradient(x[rows]), x[rows], T[:, rows], position[:, rows]
        error = rng.normal(scale=radians(self.noise), size=T.shape)
        T, position = T + error, position + np.cumsum(error * steps, axis=1)
        return Trajectory(
            {
                "drilled_length": x,
                "borehole_inclination": np.arctan2(np.hypot(T[0], T[1]), T[2]),
                "borehole_azimuth": np.arctan2(T[1], T[0]),
                "north": position[0],
                "east": position[1],
                "true_vertical_depth": position[2],
            }
        )


@st.composite
def made(draw: st.DrawFn) -> Made:
    """Ellipses of any shape that is not between a line and an ellipse, in holes of any kind, through noise."""
    ratio = draw(st.sampled_from((0.0, 1.0, -1.0))) * draw(st.floats(0.25, 1.0))
    major = draw(st.floats(0.1, 3.0))
    return Made(
        pitch=draw(st.floats(0.8, 16.0)),
        major=major,
        ratio=ratio,
        side=draw(st.floats(0.0, pi)),
        inclination=draw(st.floats(8.0, 80.0)),
        build=draw(st.floats(-1.0, 1.0)),
        walk=draw(st.floats(-2.0, 2.0)),
        rows=draw(st.floats(10.0, 60.0)),
        uneven=draw(st.booleans()),
        noise=draw(st.floats(0.0, 0.1)) * major,
        seed=draw(st.integers(0, 10**6)),
    )


@settings(max_examples=60)
@given(made())
def test_any_ellipse_is_found_with_its_sense_through_drift_and_noise(hole: Made) -> None:
    found = find_rippling(hole.run())
    assert found.ripples
    assert found.wavelength == pytest.approx(hole.pitch, rel=0.02)
    assert found.ellipse is not None
    assert found.ellipse.shape == (Shape.PLANE if hole.ratio == 0 else TO_A_SIDE[hole.ratio < 0])
    major = radians(hole.major) * hole.pitch / 2 / pi
    assert found.ellipse.major == pytest.approx(major, rel=0.1)
    assert found.ellipse.minor == pytest.approx(abs(hole.ratio) * major, abs=0.1 * major)
    if abs(hole.ratio) < 0.8 and not found.ellipse.from_north:
        off = (found.ellipse.direction - hole.side) % pi
        assert min(off, pi - off) < 0.15


@settings(max_examples=60)
@given(
    made(),
    st.sampled_from((0.0, 0.3, 1.0)),
    st.floats(0.0, 0.2),
    st.floats(5.5, 40.0),
    st.floats(-3.0, 3.0),
    st.floats(0.0, 90.0),
)
def test_no_noise_makes_a_plane_wind_or_turns_a_spiral_round(
    hole: Made, ratio: float, noise: float, waves: float, build: float, inclination: float
) -> None:
    """In short records, too, and near the vertical: what noise hides is unclear."""
    ratio = ratio if hole.ratio >= 0 else -ratio
    hole = replace(
        hole, ratio=ratio, noise=noise * hole.major, waves=waves, build=build, walk=-build, inclination=inclination
    )
    found = find_rippling(hole.run())
    if found.ripples:
        assert found.ellipse is not None
        true = TO_A_SIDE[ratio < 0] if ratio else Shape.PLANE
        assert found.ellipse.shape in (true, Shape.UNCLEAR)


@settings(max_examples=40)
@given(made())
def test_drift_and_noise_alone_are_no_wave_in_space(hole: Made) -> None:
    straight = replace(hole, major=0.0, noise=max(hole.noise, 0.01))
    assert find_rippling(straight.run()).state is State.NONE


def test_a_spiral_of_some_microns_is_measured_in_a_hole_that_turns() -> None:
    """Where the axis is metres off the chord of a wave: that of the trend must not be seen in the ellipse."""
    hole = Made(pitch=9.0, major=2e-3, inclination=30.0, build=3.0, walk=3.0, rows=19.3)
    found = find_rippling(hole.run())
    assert found.ellipse is not None
    assert found.ellipse.shape is Shape.RIGHT
    axes = [found.ellipse.major, found.ellipse.minor]
    assert axes == pytest.approx([radians(hole.major) * hole.pitch / 2 / pi] * 2, rel=0.1)


@pytest.mark.parametrize("missing", [("north",), ("north", "east"), ("north", "east", "borehole_azimuth")])
def test_a_run_in_space_is_not_taken_for_a_planar_one_where_columns_are_missing(missing: tuple[str, ...]) -> None:
    run = Made().run()
    case = replace(paper_spiral(), dimensions=3)
    left = Trajectory({name: column for name, column in run.columns.items() if name not in missing}, case)
    with pytest.raises(MissingColumn, match=f"'{missing[-1] if len(missing) == 3 else missing[0]}'"):
        find_rippling(left)


def test_where_a_spiral_begins_is_told() -> None:
    found = find_rippling(Made(start=60.0).run())
    assert found.since == pytest.approx(60.0, abs=3.0)
    assert found.ellipse is not None
    assert found.ellipse.since == pytest.approx(60.0, abs=6.0)


def test_waves_that_wind_to_one_side_and_to_the_other_by_turns_are_neither() -> None:
    found = find_rippling(Made(turns=5, waves=50.0).run())
    assert found.ripples
    assert found.ellipse is not None
    assert found.ellipse.shape is Shape.UNCLEAR


def test_a_figure_of_eight_is_neither_in_a_plane_nor_to_one_side() -> None:
    hole = Made(ratio=0.0, side=0.0).run()
    x = hole["drilled_length"]
    across = 0.05 * np.sin(4 * pi * x / 6.0 + 2.0)  # to the right, twice in a wave
    columns = dict(hole.columns)
    columns["north"], columns["east"] = hole["north"] - across * np.sin(1.0), hole["east"] + across * np.cos(1.0)
    found = find_rippling(Trajectory(columns))
    assert found.ellipse is not None
    assert found.ellipse.shape is Shape.UNCLEAR


def test_a_well_that_winds_over_hundreds_of_metres_does_not_spiral() -> None:
    bha = paper_spiral().bha
    run = Made(pitch=100.0, major=8.0, rows=1000.0, waves=8.0, inclination=20.0).run()
    assert find_rippling(run, longest=6.0 * bha.half_length).state is State.NONE


# holes that are drilled


def ends_in(case: Case, lengths: float) -> Rippling:
    """What the waves of a case are after so many ℓ₁ in space."""
    return find_rippling(simulate(case, length=lengths * case.length_scale, dimensions=3))


@drills
@pytest.mark.parametrize("azimuth_deg", [0.0, 45.0, 130.0])
def test_the_ripple_of_the_paper_in_space_is_the_planar_one_in_its_plane(azimuth_deg: float) -> None:
    case = replace(paper_spiral(), length=150.0)
    planar = find_rippling(simulate(case))
    survey = replace(case.survey, azimuth=(radians(azimuth_deg),) * len(case.survey.measured_depth))
    found = find_rippling(simulate(replace(case, survey=survey), dimensions=3))
    assert (found.state, found.switching) == (planar.state, planar.switching)
    for name in ("wavelength", "amplitude", "axis_amplitude", "since"):
        assert getattr(found, name) == pytest.approx(getattr(planar, name), rel=1e-3), name
    assert found.ellipse is not None
    assert (found.ellipse.shape, found.ellipse.from_north) == (Shape.PLANE, True)
    off = (degrees(found.ellipse.direction) - azimuth_deg) % 180.0
    assert min(off, 180.0 - off) < 0.01


@drills
@pytest.mark.parametrize(
    ("walk_deg", "shape", "pitch", "radius"),  # as `boreprop spiral` prints them
    [(0.0, Shape.RIGHT, 5.102, 21.41e-3), (5.0, Shape.RIGHT, 5.110, 21.43e-3), (-5.0, Shape.LEFT, 5.110, 21.43e-3)],
)
def test_a_ripple_that_is_disturbed_becomes_the_spiral_of_the_closed_form(
    walk_deg: float, shape: Shape, pitch: float, radius: float
) -> None:
    found = ends_in(disturbed(paper_spiral(walk_deg=walk_deg)), 70.0)
    assert found.state is State.LASTING
    assert found.wavelength == pytest.approx(pitch, rel=3e-4)
    assert found.ellipse is not None
    assert found.ellipse.shape is shape
    assert [found.ellipse.major, found.ellipse.minor] == pytest.approx([radius] * 2, rel=2e-3)
    assert found.since < 20.0
    assert walk_deg or found.ellipse.since > 50.0


@drills
@pytest.mark.parametrize("inclination_deg", [10.0, 30.0, 60.0])
def test_inclined_holes_spiral_in_ellipses_that_are_nearly_circles(inclination_deg: float) -> None:
    """Those of their directions, freed of the trend by least squares, are as narrow; measured with it they are not."""
    case = disturbed(paper_spiral(), 0.1, inclination_deg)
    run = simulate(case, length=60.0 * case.length_scale, dimensions=3)
    found = find_rippling(run)
    assert found.ellipse is not None
    assert found.ellipse.shape in TO_A_SIDE
    ratio = found.ellipse.minor / found.ellipse.major
    assert ratio == pytest.approx({10.0: 1.0, 30.0: 0.997, 60.0: 0.989}[inclination_deg], abs=2e-3)
    assert ratio == pytest.approx(narrowness(run, found.wavelength), abs=2e-3)
    assert found.wavelength == pytest.approx(5.10, rel=2e-3)


def narrowness(run: Trajectory, wavelength: float, waves: int = 6) -> float:
    """Minor over major axis of the ellipse of the last directions: what winds to either side, by least squares."""
    x, z = run["drilled_length"] - run["drilled_length"][-1], direction_of(run)
    last = x > -waves * wavelength
    turns = [k for k in range(-5, 6) if k]
    terms = [x**k for k in range(3)] + [np.exp(2j * pi * k * x / wavelength) for k in turns]
    parts = np.linalg.lstsq(np.column_stack(terms)[last], z[last])[0][3:]
    right, left = (abs(parts[turns.index(k)]) for k in (1, -1))
    return float(abs(right - left) / (right + left))


@drills
def test_a_ripple_stays_in_its_plane_where_the_tilt_is_limited_to_half_a_degree() -> None:
    found = ends_in(disturbed(paper_spiral(tilt_limit_deg=0.5), 0.1), 80.0)
    assert found.ripples
    assert found.ellipse is not None
    assert found.ellipse.shape is Shape.PLANE


def areas(run: Trajectory, wavelength: float) -> Floats:
    """What the hole goes round in each of its last four waves, in shares of a circle, positive to the right."""
    x = run["drilled_length"]
    position = np.column_stack([run[name] for name in ("north", "east", "true_vertical_depth")])
    found = []
    for k in range(4):
        at = x[-1] - wavelength * (k + 1 - np.linspace(0.0, 1.0, 401))
        ring = np.column_stack([np.interp(at, x, along) for along in position.T])
        chord = ring[-1] - ring[0]
        inclination, azimuth = np.arctan2(np.hypot(*chord[:2]), chord[2]), np.arctan2(chord[1], chord[0])
        high, right, _ = (side[0] for side in trihedron(np.array([inclination]), np.array([azimuth])))
        flat = (ring - ring[0]) @ (high + 1j * right)
        flat = flat - flat.mean()
        found.append(np.sum(np.imag(np.conj(flat[:-1]) * np.diff(flat))) / np.mean(abs(flat) ** 2) / 2 / pi)
    return np.array(found)


@drills
@pytest.mark.parametrize(
    ("entry", "walk_deg", "shape"),
    [(0, 0.0, Shape.LEFT), (21, 10.0, Shape.RIGHT), (20, -5.0, Shape.LEFT), (3, 0.0, Shape.PLANE)],
)
def test_near_bit_holes_wind_to_the_side_to_which_their_area_is(entry: int, walk_deg: float, shape: Shape) -> None:
    case = near_bit_case(NEAR_BIT["ripples"][entry], 150.0)
    bent = replace(case.survey, azimuth=(1.0, 1.0, 1.0 if shape is Shape.PLANE else 1.3))
    case = replace(case, survey=bent, bit=replace(case.bit, walk_angle=radians(walk_deg)))
    run = simulate(case, dimensions=3)
    found = find_rippling(run)
    assert found.ripples
    assert found.ellipse is not None
    assert found.ellipse.shape is shape
    round_about = areas(run, found.wavelength)
    if shape is Shape.PLANE:
        assert np.abs(round_about).max() < 0.1
    else:
        assert (round_about * (1 if shape is Shape.RIGHT else -1)).min() > 0.2


@drills
def test_the_summary_says_spiral_or_plane() -> None:
    case = disturbed(paper_spiral(), 1e-4)
    early, late = (simulate(case, length=m * case.length_scale, dimensions=3) for m in (25.0, 80.0))
    said = dict(lines(summarize(late)))
    assert said["rippling"] == "yes: 5.10 m long, a spiral to the right"
    assert said["ripple of the hole axis"] == "±21.4 mm by ±21.4 mm"
    assert "spiral since" in said
    said = dict(lines(summarize(early)))
    assert said["rippling"].endswith("long, in a plane")
    assert said["ripple of the hole axis"].endswith(", at azimuth 0°")
