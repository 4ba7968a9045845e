"""Draws the icon of the FMU, a bottom-hole assembly in the curved hole that it drills.

python docs/make_icon.py
"""

from math import degrees
from pathlib import Path

from PIL import Image, ImageDraw

ICON = Path(__file__).parents[1] / "fmu_build" / "boreprop_fmu" / "pack" / "icon.png"
SIZE, FINER = 100, 8  # pixels, and how much finer it is drawn first, for smooth edges
CENTRE, RADIUS = (104.5, -3.5), 76.0  # of the arc that the hole follows
ROCK, MUD, STEEL, BIT = (122, 90, 62), (236, 224, 200), (58, 66, 78), (200, 72, 40)
BOTTOM = 1.88  # where on the arc the bit is, rad from the x axis
ARCS = (  # from, to, half width, colour: hole, pipe, bit, first and last stabilizer
    (BOTTOM, 4.0, 12.0, MUD),
    (BOTTOM, 4.0, 3.5, STEEL),
    (BOTTOM - 0.09, BOTTOM + 0.09, 11.0, BIT),
    (2.16, 2.28, 9.0, STEEL),
    (2.74, 2.86, 9.0, STEEL),
)


def main() -> None:
    """Write the icon beside the code that packs it."""
    image = Image.new("RGB", (FINER * SIZE, FINER * SIZE), ROCK)
    draw = ImageDraw.Draw(image)
    for start, end, half_width, colour in ARCS:
        outer = FINER * (RADIUS + half_width)
        x, y = FINER * CENTRE[0], FINER * CENTRE[1]
        box = (x - outer, y - outer, x + outer, y + outer)
        draw.arc(box, degrees(start), degrees(end), colour, width=round(2 * FINER * half_width))
    image.resize((SIZE, SIZE), Image.Resampling.BOX).save(ICON, optimize=True)


if __name__ == "__main__":
    main()
