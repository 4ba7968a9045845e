"""The command `boreprop`."""

from typing import NoReturn

from .console import many_commands, run

COMMANDS = {  # name: its module, and the line about it in the help
    "simulate": ("boreprop.cli.simulate", "Drill a case and write the run to a file."),
    "summary": ("boreprop.cli.summary", "Print a run in a dozen numbers."),
    "steering": ("boreprop.cli.steering", "Print how fast a steady steering force turns the hole, and draw it."),
    "roots": ("boreprop.cli.stability", "Print what becomes of small disturbances of a straight hole."),
    "stability": ("boreprop.cli.stability", "Draw where a straight hole is stable, drifts or oscillates."),
    "dogleg": ("boreprop.cli.tipping", "Print the smallest kink in the existing hole that starts rippling."),
    "hysteresis": ("boreprop.cli.tipping", "Draw where a ripple dies out, and where it comes back."),
    "study": ("boreprop.cli.study", "Drill many cases on all cores: a grid, or uncertain parameters."),
    "figures": ("boreprop.cli.figures", "Draw the paper's figures 6, 7 and 8."),
}

app = many_commands("Borehole propagation of a directional drilling system.", COMMANDS)


def main() -> NoReturn:
    """Run the command `boreprop`."""
    run(app)


if __name__ == "__main__":
    main()
