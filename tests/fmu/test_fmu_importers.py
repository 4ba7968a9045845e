"""The same FMU in two importers that share no code: fmpy (Python) and libcosim (C++). In processes of their own."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flavours import both_flavours
from places import HOSTS
from scenarios import report

pytest.importorskip("libcosimpy")


def host(scenario: str, *arguments: object) -> Any:
    """What a scenario of fmu_cosim_host.py gives."""
    return np.array(report("fmu_cosim_host", scenario, *arguments))


@pytest.fixture(scope="module")
def steering(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("steering")
    command = [
        sys.executable,
        "-m",
        "pythonfmu",
        "build",
        "-f",
        str(HOSTS / "fmu_steering_slave.py"),
        "-d",
        str(folder),
    ]
    subprocess.run([*command, "--no-external-tool"], check=True, capture_output=True, cwd=folder)
    return folder / "Steering.fmu"


@both_flavours
def test_libcosim_and_fmpy_agree_on_a_run_whose_force_changes(fmu: Path) -> None:
    rows, expected = host("alone", fmu, 0.5, 40), host("alone_in_fmpy", fmu, 0.5, 40)
    np.testing.assert_array_equal(rows, expected)
    assert rows[-1, 0] == 40.0


@both_flavours
def test_libcosim_and_fmpy_agree_on_a_loop_closed_through_a_second_fmu(fmu: Path, steering: Path) -> None:
    # steps of 1/8 s: the times are the same floats, whether a master adds them up or counts them
    rows, expected = host("connected", fmu, steering, 0.125, 320), host("connected_in_fmpy", fmu, steering, 0.125, 320)
    np.testing.assert_array_equal(rows, expected)
    assert rows[0, 1] < 0.01
    assert np.abs(rows[-80:, 1] - 0.1).max() < 0.05  # rad: where the second FMU steers
