"""The icon of the FMU, drawn pixel by pixel: a bottom-hole assembly in the curved hole that it drills."""

import struct
import zlib
from math import atan2, hypot

SIZE = 100  # pixels
CENTRE, RADIUS = (104.0, -4.0), 76.0  # of the arc that the hole follows
HOLE, PIPE = 12.0, 3.5  # half widths
ROCK, MUD, STEEL, BIT = (122, 90, 62), (236, 224, 200), (58, 66, 78), (200, 72, 40)
STATIONS = ((1.88, 0.09, 11.0, BIT), (2.22, 0.06, 9.0, STEEL), (2.80, 0.06, 9.0, STEEL))
# along the arc in rad, half length in rad, half width, colour: bit, first and last stabilizer

Colour = tuple[int, int, int]


def icon() -> bytes:
    """A PNG, `SIZE` pixels square."""
    rows = b"".join(b"\0" + b"".join(bytes(colour(x, y)) for x in range(SIZE)) for y in range(SIZE))
    header = struct.pack(">IIBBBBB", SIZE, SIZE, 8, 2, 0, 0, 0)
    chunks = (b"IHDR", header), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )


def colour(x: int, y: int) -> Colour:
    """Colour of a pixel: the layers over each other."""
    dx, dy = x - CENTRE[0], y - CENTRE[1]
    off, along = abs(hypot(dx, dy) - RADIUS), atan2(dy, dx) % 6.283185307179586
    painted = blend(ROCK, MUD, min(HOLE - off, (along - STATIONS[0][0]) * RADIUS))
    painted = blend(painted, STEEL, min(PIPE - off, (along - STATIONS[0][0]) * RADIUS))
    for at, half_length, half_width, paint in STATIONS:
        painted = blend(painted, paint, min(half_width - off, (half_length - abs(along - at)) * RADIUS))
    return painted


def blend(below: Colour, above: Colour, inside: float) -> Colour:
    """`above` over `below`, its edge smoothed over a pixel; `inside` is the distance from that edge, pixels."""
    share = min(max(inside + 0.5, 0.0), 1.0)
    r, g, b = (round(a + share * (c - a)) for a, c in zip(below, above, strict=True))
    return r, g, b
