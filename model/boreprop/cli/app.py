"""The command `boreprop`: the commands that it has, and where they are."""

from typing import NoReturn

from . import console
from .lazy import new_group

COMMANDS = {  # name → module and what it does
    "new": ("boreprop.cli.new", "Write a case file, with comments, from what an engineer knows."),
    "simulate": ("boreprop.cli.simulate", "Simulate a case and write the run to a file."),
    "summary": ("boreprop.cli.summary", "Print a run in a dozen numbers, and whether it ripples."),
    "compare": ("boreprop.cli.comparison", "Print what a run predicts beside what a survey measured, and draw it."),
    "steering": ("boreprop.cli.steering", "Print how fast a steady steering force turns the hole, and draw it."),
    "study": ("boreprop.cli.study", "Simulate many cases on all cores: over a grid, or of uncertain parameters."),
    "dogleg": (
        "boreprop.cli.tipping",
        "Print the smallest kink in the existing hole that starts rippling, and map it.",
    ),
    "hysteresis": ("boreprop.cli.tipping", "Draw where a ripple dies out on the way up, and returns on the way down."),
    "roots": ("boreprop.cli.stability", "Print whether each mode of a case is stable, drifts or oscillates."),
    "stability": ("boreprop.cli.stability", "Draw the stability chart of a case over ηΠ and λ₂, and print its limits."),
    "spiral": (
        "boreprop.cli.spiral",
        "Print the spiral into which a case drills a vertical hole, whether it lasts, and where it ends.",
    ),
    "figures": ("boreprop.cli.figures", "Draw the paper's figures 6, 7 and 8 (PNG)."),
}

app = new_group("Borehole propagation of a directional drilling system.", COMMANDS)


def main() -> NoReturn:
    """Run the command `boreprop`."""
    console.execute(app)


if __name__ == "__main__":
    main()
