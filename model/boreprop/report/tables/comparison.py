"""A run beside a survey, in a table."""

from math import isnan

from ...analysis.comparison import Comparison
from ...units import UNITS


def headings() -> tuple[str, ...]:
    """The headings of the columns of `lines`, with their units."""
    return tuple(
        f"{name}\n({UNITS[unit].shown})"
        for name, unit in (
            ("MD", "m"),
            ("predicted", "rad"),
            ("measured", "rad"),
            ("difference", "rad"),
            ("build, pred.", "rad/m"),
            ("build, meas.", "rad/m"),
        )
    )


def lines(found: Comparison) -> list[tuple[str, ...]]:
    """A line for each station, with a cell for each of `headings`."""
    columns = (
        ("m", "", found.measured_depth),
        ("rad", "", found.predicted),
        ("rad", "", found.measured),
        ("rad", "+z.2f", found.residual),
        ("rad/m", "+z.2f", found.predicted_build_rate),
        ("rad/m", "+z.2f", found.measured_build_rate),
    )
    cells = [
        ["–" if isnan(value) else UNITS[unit].number(value, digits) for value in values.tolist()]
        for unit, digits, values in columns
    ]
    return list(zip(*cells, strict=True))


def caption(found: Comparison) -> str:
    """What the columns mean, and how far apart the two are."""
    mean, rms = (UNITS["rad"].text(value, "+z.2f") for value in (found.residual.mean(), found.root_mean_square))
    return (
        f"Inclinations of the run: means over {UNITS['m'].text(found.averaging_length, '.3g')} around the station. "
        "Build rates: since the station before. "
        f"Measured less predicted: {mean} in the mean, {rms.lstrip('+')} as a root mean square."
    )
