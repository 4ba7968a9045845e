"""What FMUs do in processes of their own, where the model is nowhere but in the FMU: the scenarios of tests/hosts."""

import json
import subprocess
from typing import Any

from forking import run_script
from places import HOSTS


def play(host: str, scenario: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """The process in which a host has played a scenario to its end."""
    done = run_script([HOSTS / f"{host}.py", scenario, *map(str, arguments)], ("fmpy", "fmpy.fmi2", "psutil"))
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def report(host: str, scenario: str, *arguments: object) -> Any:
    """What the scenario gives: the last line that is printed, as libraries may print before it."""
    return json.loads(play(host, scenario, *arguments).stdout.splitlines()[-1])
