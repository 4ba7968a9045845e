"""The wheels that are looked at: that for this machine, or with ``--wheels FOLDER`` all that `build_wheels.py` made.

`target` is the platform of each, one after the other.
"""

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from boreprop.kernel.compiler import PLATFORMS, host_platform
from places import ROOT

WHOLE = {"test_archives.py", "test_elsewhere.py", "test_installed.py"}  # minutes, which only `make wheels` takes


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    return True if collection_path.name in WHOLE and not config.getoption("--wheels") else None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "target" in metafunc.fixturenames:
        here = [name for name in [host_platform()] if name]
        metafunc.parametrize("target", PLATFORMS if metafunc.config.getoption("--wheels") else here, scope="session")


@pytest.fixture(scope="session")
def archives(request: pytest.FixtureRequest) -> Path:
    """The folder of all wheels and of the source distribution."""
    return Path(request.config.getoption("--wheels")).resolve()


@pytest.fixture(scope="session")
def wheel(request: pytest.FixtureRequest, target: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel for a platform; without ziglang its tests are skipped."""
    if request.config.getoption("--wheels"):
        folder: Path = request.getfixturevalue("archives")
        (found,) = folder.glob(f"*-{PLATFORMS[target].tag}.whl")
        return found
    pytest.importorskip("ziglang")
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "--target", "wheel", "--directory", str(folder)]
    subprocess.run(command, cwd=ROOT, env=os.environ | {"BOREPROP_PLATFORM": target}, check=True)
    (made,) = folder.iterdir()
    return made


@pytest.fixture(scope="session")
def contents(wheel: Path) -> dict[str, bytes]:
    """What is in it: path → content."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}
