"""The key: what each colour means, in a row of its own above the plots.

A legend inside a plot would cover the curves, so the plots have none. The key is drawn as a picture: its unit of length
is a pixel of a small window, and in a larger window it grows.
"""

from collections.abc import Iterator, Sequence
from itertools import zip_longest

import numpy as np
import rerun as rr

from .furniture import log_labels
from .style import BIT, BLUE, BODY, BY_STABILIZER, GREY, HOLE, OLIVE, PLAN, RSS, Colour
from .track import Track

KEY = "key"
WIDTH, LINE = 600.0, 26.0  # of the key and of one of its lines
ABOVE = 13.0  # by which a viewer draws a text below its place
LONGEST = 40  # letters of a name, which may be wide ones
SWATCH, GAP, LETTER, MARGIN = 18.0, 8.0, 7.0, 20.0  # width of a coloured line, of what is between two, of a letter, …

Entry = tuple[str, Colour]


def entries(tracks: Sequence[Track], planned: bool) -> list[Entry]:
    """What the colours of a recording mean: name → colour."""
    n = max(len(track.case.bha.stabilizer_positions) for track in tracks)
    plan = [("plan", PLAN)] if planned else []
    if len(tracks) == 1:
        stabilizers = [(f"stabilizer {i}", colour) for i, colour in enumerate(BY_STABILIZER[: n - 1], 1)]
        body = [("body on the wall", BODY)] if tracks[0].case.bha.body_point_positions else []
        own = [("RSS", RSS), *stabilizers, *body, ("dogleg severity", OLIVE)]
        if tracks[0].scales.space is not None:
            own += [("magnitude", GREY), ("walk rate, right, east", BLUE)]
        return [("hole", HOLE), ("BHA, bit", BIT), *plan, *own]
    runs = [(shortened(track.name), track.colour or GREY) for track in tracks]
    numbers = [f"stabilizer {i}" for i in range(1, n)]
    sides = ("low, +", "high, −") if tracks[0].scales.space is None else ("north", "east")
    firsts = zip_longest(("hole, build rate", "bit, dogleg severity"), numbers, sides)
    kinds = [", ".join(filter(None, first)) for first in firsts]
    return [*runs, *plan, *zip(kinds, tracks[0].shades(BY_STABILIZER[: len(kinds)]), strict=True)]


def shortened(name: str) -> str:
    """A name without its middle if it is too long for a line: a viewer shows no text that is wider than its view."""
    return name if len(name) <= LONGEST else f"{name[: LONGEST // 2]}…{name[-LONGEST // 2 :]}"


def places(entries: Sequence[Entry]) -> Iterator[tuple[float, float]]:
    """Where each entry begins: one after the other, in as many lines as they need."""
    x, y = MARGIN, LINE / 2
    for name, _ in entries:
        if x > MARGIN and x + width(name) > WIDTH:
            x, y = MARGIN, y + LINE
        yield x, y
        x += width(name) + GAP


def width(name: str) -> float:
    """The width of an entry."""
    return SWATCH + MARGIN + LETTER * len(name)


def line_count(entries: Sequence[Entry]) -> int:
    """The number of lines of a key."""
    return round(max(y for _, y in places(entries)) / LINE + 0.5)


def log_key(rec: rr.RecordingStream, entries: Sequence[Entry]) -> None:
    """A coloured line for each entry, and its name."""
    starts = list(places(entries))
    rec.log(
        f"{KEY}/lines",
        rr.LineStrips2D(
            [[(x, y), (x + SWATCH, y)] for x, y in starts],
            colors=[colour for _, colour in entries],
            radii=rr.Radius.ui_points(2.0),
        ),
        static=True,
    )
    widths = [width(name) - SWATCH for name, _ in entries]
    middles = [(x + SWATCH + wide / 2, y - ABOVE) for (x, y), wide in zip(starts, widths, strict=True)]
    log_labels(rec, f"{KEY}/names", np.array(middles), [name for name, _ in entries])
