"""A run at survey stations, and how far it is off its plan, in tables."""

from math import isnan

import numpy as np

from ...analysis.plan import Deviation
from ...analysis.plan_in_space import DeviationInSpace
from ...analysis.stations import Stations
from ...arrays import Floats
from ...run.completion import case_of
from ...run.trajectory import Trajectory
from ...units import UNITS

SIGNED = "+z.2f"
NONE = "–"  # below the end of the plan, or the azimuth or a side of a vertical hole


def headings(stations: Stations) -> tuple[str, ...]:
    """The headings of the columns of `lines`, with their units; `caption` says what they mean."""
    named = [("MD", "m"), ("incl.", "rad"), ("TVD", "m"), ("displ.", "m"), ("DLS", "rad/m")]
    if stations.azimuth is not None:
        named[2:4] = [("azim.", "rad"), ("TVD", "m"), ("north", "m"), ("east", "m")]
    if stations.deviation is not None and stations.azimuth is not None:
        named[4:6] = []
        named += [("off\nincl.", "rad"), ("off\nazim.", "rad"), ("high", "m"), ("right", "m")]
    elif stations.deviation is not None:
        named += [("planned", "rad"), ("off plan", "rad"), ("off plan", "m")]
    return tuple(f"{name}\n({UNITS[unit].shown})" for name, unit in named)


def lines(stations: Stations) -> list[tuple[str, ...]]:
    """A line for each station, with a cell for each of `headings`."""
    columns = [
        _cells("m", stations.measured_depth),
        _cells("rad", stations.inclination),
        _cells("m", stations.true_vertical_depth, ".2f"),
        _cells("m", stations.displacement, ".2f"),
        _cells("rad/m", stations.dogleg_severity, ".2f"),
    ]
    if stations.azimuth is not None and stations.north is not None and stations.east is not None:
        columns[3:4] = [_cells("m", stations.north, ".2f"), _cells("m", stations.east, ".2f")]
        columns.insert(2, _cells("rad", stations.azimuth, ".1f"))
    if isinstance(off := stations.deviation, DeviationInSpace):
        columns[4:6] = []
        columns += [_cells("rad", angle, SIGNED) for angle in (off.inclination, off.azimuth)]
        columns += [_cells("m", distance, SIGNED) for distance in (off.high, off.right)]
    elif off is not None:
        columns += [
            _cells("rad", off.planned_inclination),
            _cells("rad", off.inclination, SIGNED),
            _cells("m", off.distance, SIGNED),
        ]
    return list(zip(*columns, strict=True))


def _cells(unit: str, values: Floats, digits: str = "") -> list[str]:
    return [NONE if isnan(value) else UNITS[unit].number(value, digits) for value in values.tolist()]


def caption(stations: Stations) -> str:
    """What the columns of `lines` mean."""
    over = UNITS["m"].text(stations.averaging_length, ".3g")
    in_plane = stations.azimuth is None
    across = "Displ.: horizontal distance" if in_plane else "North, east: distance"
    where = f"{across} from the bit at the start. " if in_plane or stations.deviation is None else ""
    text = (
        f"MD: measured depth. TVD: true vertical depth, 0 at the start unless the case gives it. {where}"
        f"Inclinations{'' if in_plane else ' and azimuths'}: means over the last {over} of hole. "
        f"DLS: dogleg severity since the station before, at least over {over}."
    )
    if stations.deviation is None:
        return text
    if in_plane:
        return f"{text} Off plan: + to the high side of its nearest point."
    return f"{text} Off: inclination and azimuth less those of the plan. High, right: from its nearest point."


def plan_lines(run: Trajectory, off: Deviation | DeviationInSpace) -> list[tuple[str, str]]:
    """Two lines for the summary of a run with its case: how far its rows are off the plan at the end, and at most."""
    measured_depth = case_of(run).survey.measured_depth[-1] + run["drilled_length"]
    known = np.flatnonzero(~np.isnan(off.distance))
    last, most = known[-1], known[np.argmax(np.abs(off.distance[known]))]
    where = (
        "at the end" if last == len(measured_depth) - 1 else f"where it ends, {UNITS['m'].text(measured_depth[last])}"
    )
    angles = {"inclination": off.inclination}
    if isinstance(off, DeviationInSpace):
        angles["azimuth"] = off.azimuth
    turned = [
        f"{name} {UNITS['rad'].text(angle[last], SIGNED)}" for name, angle in angles.items() if not isnan(angle[last])
    ]
    return [
        (f"off the plan {where}", ", ".join([_away(off, int(last)), *turned])),
        ("off the plan at most", f"{_away(off, int(most))} at {UNITS['m'].text(measured_depth[most])}"),
    ]


def _away(off: Deviation | DeviationInSpace, row: int) -> str:
    """How far a row is from the plan, in words: where the plan is nearly vertical, without the sides."""
    if isinstance(off, Deviation):
        return beside(off.distance[row])
    if isnan(off.high[row]):
        return UNITS["m"].text(off.distance[row], ".2f")
    return f"{beside(off.high[row])}, {beside(off.right[row], sides=('right', 'left'))}"


def beside(distance: float, digits: str = ".2f", sides: tuple[str, str] = ("high", "low")) -> str:
    """A distance from the plan, m, and its side, in words; the first of the sides is that where it is positive."""
    return f"{UNITS['m'].text(abs(distance), digits)} {sides[0] if distance > 0 else sides[1]}"
