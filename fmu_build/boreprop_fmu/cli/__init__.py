"""The command `boreprop-fmu`: the commands that it has, and where they are."""

from typing import NoReturn

from boreprop.cli import console
from boreprop.cli.lazy import new_group

COMMANDS = {  # name → module and what it does
    "build": ("boreprop_fmu.cli.build", "Pack a case, and the model with it, as an FMU."),
    "run": ("boreprop_fmu.cli.run", "Run an FMU and write the run to a file."),
}

app = new_group("The borehole as a component of a system simulation: an FMI 2.0 co-simulation FMU.", COMMANDS)


def main() -> NoReturn:
    """Run the command `boreprop-fmu`."""
    console.execute(app)
