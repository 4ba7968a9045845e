"""What several test files need."""

import os
import shutil
import subprocess
import sysconfig
from collections.abc import Callable
from pathlib import Path

import hypothesis
import pytest

from boreprop.case import Case, load_case
from boreprop_fmu.build import build_fmu

# a landing tries the same examples as the last one, a developer's run new ones
hypothesis.settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    hypothesis.settings.load_profile("ci")

EXAMPLES = Path(__file__).parents[1] / "examples"

Command = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def paper_case() -> Path:
    """The case file of the paper's case."""
    return EXAMPLES / "paper_case.toml"


@pytest.fixture(scope="session")
def paper_text(paper_case: Path) -> str:
    """What is in it, without the comments (so that a text replaced is a value replaced)."""
    lines = paper_case.read_text(encoding="utf-8").splitlines()
    return "\n".join(line.partition("#")[0].rstrip() for line in lines)


@pytest.fixture(scope="session")
def case(paper_case: Path) -> Case:
    """The paper's case, from its file."""
    return load_case(paper_case)


@pytest.fixture(scope="session")
def fmu(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its FMU."""
    return build_fmu(case, tmp_path_factory.mktemp("fmu") / "Borehole.fmu")


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Run an installed command in `tmp_path`: ``command("boreprop", "simulate", …)``."""

    def run(name: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        program = shutil.which(name, path=sysconfig.get_path("scripts"))
        assert program, f"{name} is not installed"
        return subprocess.run(
            [program, *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True, encoding="utf-8", timeout=300
        )

    return run
