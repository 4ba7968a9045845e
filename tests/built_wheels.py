"""The archives that are looked at: with ``--wheels FOLDER`` all that `build_wheels.py` made there; else none.

`target` is the platform of each wheel, one after the other.
"""

import zipfile
from pathlib import Path

import pytest

from boreprop.kernel.compiler import PLATFORMS


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    return True if collection_path.name == "wheels" and not config.getoption("--wheels") else None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "target" in metafunc.fixturenames:
        metafunc.parametrize("target", PLATFORMS, scope="session")


@pytest.fixture(scope="session")
def archives(request: pytest.FixtureRequest) -> Path:
    """The folder of all wheels and of the source distribution."""
    return Path(request.config.getoption("--wheels")).resolve()


@pytest.fixture(scope="session")
def wheel(archives: Path, target: str) -> Path:
    """The wheel for a platform."""
    (found,) = archives.glob(f"*-{PLATFORMS[target].tag}.whl")
    return found


@pytest.fixture(scope="session")
def contents(wheel: Path) -> dict[str, bytes]:
    """What is in it: path → content."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}
