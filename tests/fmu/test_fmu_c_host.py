"""The FMU in a host that is not Python, as the README says: on Linux with libpython preloaded."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from signal import SIGINT
from xml.etree.ElementTree import fromstring

import pytest

from boreprop.case.case import Case
from boreprop.run.simulate import simulate
from places import HOSTS

SOURCE = HOSTS / "c_host.c"
LIBPYTHON = Path(str(sysconfig.get_config_var("LIBDIR")), str(sysconfig.get_config_var("INSTSONAME")))
COMPILER = shutil.which("cc") or shutil.which("gcc")

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="the preloading is Linux's"),
    pytest.mark.skipif(COMPILER is None, reason="no C compiler"),
    pytest.mark.skipif(
        LIBPYTHON.suffix == ".a" or not LIBPYTHON.exists(), reason="this Python has no shared libpython"
    ),
]


@pytest.fixture(scope="module")
def command(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The compiled host, to take 20 steps of the FMU and print the bit inclination."""
    folder = tmp_path_factory.mktemp("c_host")
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    description = fromstring((folder / "modelDescription.xml").read_bytes())
    [bit] = description.iterfind("ModelVariables/ScalarVariable[@name='bit_inclination']")
    subprocess.run([str(COMPILER), "-O1", "-o", folder / "host", SOURCE, "-ldl"], check=True)
    library, resources = folder / "binaries" / "linux64" / "Borehole.so", (folder / "resources").as_uri()
    return [
        *map(str, (folder / "host", library, description.attrib["guid"], resources, bit.attrib["valueReference"], 20))
    ]


def run(command: list[str], **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, timeout=60)


def test_with_libpython_preloaded_it_gives_what_the_model_gives(command: list[str], case: Case) -> None:
    done = run(command, LD_PRELOAD=str(LIBPYTHON), PYTHONHOME=sys.base_prefix)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    expected = simulate(case, sample_interval=1.0, length=20.0)["bit_inclination"][1:]
    assert [float(line) for line in done.stdout.split()] == pytest.approx(expected, abs=1e-12)


def test_ctrl_c_ends_it(command: list[str]) -> None:
    done = run([*command, "interrupt"], LD_PRELOAD=str(LIBPYTHON), PYTHONHOME=sys.base_prefix)
    assert done.returncode == -SIGINT
    assert len(done.stdout.splitlines()) in (0, 20)  # what was printed may be lost with it


def test_without_it_the_binary_names_what_is_missing(command: list[str]) -> None:
    done = run(command)
    assert done.returncode == 2
    assert "undefined symbol" in done.stderr
