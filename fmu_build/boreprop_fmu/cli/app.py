"""The command `boreprop-fmu`: packs a case as an FMU, runs an FMU."""

from typing import NoReturn

from boreprop.cli import console

COMMANDS = {  # name: its module, and the line about it in the help
    "build": ("boreprop_fmu.cli.build", "Pack a case, and the model with it, as an FMU."),
    "run": ("boreprop_fmu.cli.run", "Run an FMU through fmpy."),
}

app = console.many_commands(
    "The borehole as a component of a system simulation: an FMI 2.0 co-simulation FMU.", COMMANDS
)


def main() -> NoReturn:
    """Run the command `boreprop-fmu`."""
    console.run(app)


if __name__ == "__main__":
    main()
