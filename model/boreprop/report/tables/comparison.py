"""A run beside a survey, in a table."""

from math import isnan

from ...analysis.comparison import Comparison
from ...arrays import Floats
from ...units import UNITS

SIGNED = "+z.2f"


def headings(found: Comparison) -> tuple[str, ...]:
    """The headings of the columns of `lines`, with their units."""
    return tuple(f"{name}\n({UNITS[unit].shown})" for name, unit, _, _ in _columns(found))


def lines(found: Comparison) -> list[tuple[str, ...]]:
    """A line for each station, with a cell for each of `headings`."""
    cells = [
        ["–" if isnan(value) else UNITS[unit].number(value, digits) for value in values.tolist()]
        for _, unit, digits, values in _columns(found)
    ]
    return list(zip(*cells, strict=True))


def _columns(found: Comparison) -> list[tuple[str, str, str, Floats]]:
    """Heading, unit, format and values of each column: in space azimuths and distances in place of build rates."""
    columns = [
        ("MD", "m", "", found.measured_depth),
        ("predicted", "rad", "", found.predicted),
        ("measured", "rad", "", found.measured),
        ("difference", "rad", SIGNED, found.residual),
    ]
    turned = found.azimuth_residual
    if turned is None or found.measured_azimuth is None or found.high is None or found.right is None:
        return [
            *columns,
            ("build, pred.", "rad/m", SIGNED, found.predicted_build_rate),
            ("build, meas.", "rad/m", SIGNED, found.measured_build_rate),
        ]
    return [
        *columns,
        ("azimuth", "rad", ".1f", found.measured_azimuth),
        ("diff.", "rad", SIGNED, turned),
        ("high", "m", SIGNED, found.high),
        ("right", "m", SIGNED, found.right),
    ]


def caption(found: Comparison) -> str:
    """What the columns mean, and how far apart the two are."""
    mean, rms = (UNITS["rad"].text(value, "+z.2f") for value in (found.residual.mean(), found.root_mean_square))
    columns = "Build rates: since the station before. "
    if found.high is not None:
        columns = "Azimuth: the measured one. High, right: where the measured hole is, from the predicted one. "
    return (
        f"Directions of the run: means over {UNITS['m'].text(found.averaging_length, '.3g')} around the station. "
        f"{columns}Measured less predicted: {mean} in the mean, {rms.lstrip('+')} as a root mean square."
    )
