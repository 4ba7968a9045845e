"""The listing at survey stations, against arcs in closed form and a rippling run."""

from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest

from boreprop.analysis.hole import SurveyedHole
from boreprop.analysis.plan import planned_hole
from boreprop.analysis.stations import list_stations, station_depths
from boreprop.analysis.summary import summarize
from boreprop.case.paper import paper_case
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Trajectory


def drilled_arc(start: float, curvature: float, length: float, zero: float) -> Trajectory:
    """A run along an arc that goes on from an existing hole of the same curvature."""
    s = np.arange(0.0, length + 0.01, 0.05)
    hole = SurveyedHole.of(Survey((0.0, length + 1.0), (start, start + (length + 1.0) * curvature)), 0.0)
    x, z = hole.at(s).T
    survey = Survey((zero - 100.0, zero), (start - 100.0 * curvature, start))
    columns = {"drilled_length": s, "displacement": x, "true_vertical_depth": z}
    return Trajectory(columns, replace(paper_case(), survey=survey))


@pytest.mark.parametrize("curvature", [radians(3.0) / 30.0, radians(-1.5) / 30.0, 0.0])
def test_an_arc_has_its_inclinations_its_depth_and_its_curvature(curvature: float) -> None:
    start, over = 0.7, 8.0
    found = list_stations(drilled_arc(start, curvature, 205.0, 1010.0), 30.0, averaged_over=over)
    np.testing.assert_allclose(found.measured_depth, [1010, 1020, 1050, 1080, 1110, 1140, 1170, 1200, 1215])
    length = found.measured_depth - 1010.0
    np.testing.assert_allclose(found.inclination, start + curvature * (length - over / 2), atol=1e-6)
    np.testing.assert_allclose(found.dogleg_severity, abs(curvature), atol=1e-6)
    inclination = start + curvature * length
    x, z = length * np.sin(start), length * np.cos(start)
    if curvature:
        x = (np.cos(start) - np.cos(inclination)) / curvature
        z = (np.sin(inclination) - np.sin(start)) / curvature
    np.testing.assert_allclose(found.displacement, x, atol=1e-5)
    np.testing.assert_allclose(found.true_vertical_depth, z, atol=1e-5)
    assert found.deviation is None


def test_against_a_straight_plan_an_arc_is_off_by_its_sagitta() -> None:
    start, curvature, over = 0.7, 1e-3, 8.0
    plan = planned_hole(Survey((1000.0, 1400.0), (start, start)), 1010.0)
    found = list_stations(drilled_arc(start, curvature, 200.0, 1010.0), 50.0, plan, averaged_over=over)
    assert found.deviation is not None
    length = found.measured_depth - 1010.0
    np.testing.assert_allclose(found.deviation.distance, (1 - np.cos(curvature * length)) / curvature, atol=1e-5)
    np.testing.assert_allclose(found.deviation.planned_inclination, start, atol=1e-12)
    np.testing.assert_allclose(found.deviation.inclination, curvature * (length - over / 2), atol=1e-6)


def test_the_stations_of_a_rippling_run_do_not_swing_with_the_ripple() -> None:
    run = simulate(paper_case(), length=200.0, sample_interval=0.05)
    summary = summarize(run)
    found = list_stations(run, 7.0)  # not a whole number of waves
    late = found.measured_depth > 60.0
    assert degrees(summary.rippling.amplitude) > 2.0
    assert degrees(np.ptp(found.inclination[late])) < 0.1
    assert degrees(found.dogleg_severity[late].max()) * 30.0 < 0.3
    at_bit = np.interp(found.measured_depth - 7.32, run["drilled_length"], run["borehole_inclination"])
    assert degrees(np.ptp(at_bit[late])) > 3.0  # which the inclination at the bit does
    assert found.averaging_length == summary.averaging_length
    assert found.inclination[[0, -1]] == pytest.approx([summary.start_inclination, summary.end_inclination], abs=1e-6)


def test_stations_are_the_start_the_multiples_in_between_and_the_end() -> None:
    assert station_depths(0.0, 90.0, 30.0).tolist() == [0.0, 30.0, 60.0, 90.0]
    assert station_depths(2594.0, 2630.0, 30.0).tolist() == [2594.0, 2610.0, 2630.0]
    assert station_depths(2601.0, 2609.0, 30.0).tolist() == [2601.0, 2609.0]
    assert station_depths(29.9999, 60.0004, 30.0).tolist() == [29.9999, 60.0004]


def test_a_spacing_that_is_not_positive_is_refused() -> None:
    with pytest.raises(ParameterError, match="spacing"):
        list_stations(drilled_arc(0.0, 0.0, 50.0, 1010.0), 0.0)
