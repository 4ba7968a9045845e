"""What make does again when something has changed."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from places import ROOT

pytestmark = pytest.mark.skipif(not shutil.which("make"), reason="no make")
C = ["model/boreprop/kernel/law.h", "model/boreprop/kernel/library.c", "fmu_build/boreprop_fmu/native/fmi2.c"]
C += ["fmu_build/boreprop_fmu/native/importer/fmi2Functions.h"]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """What make looks at, all of it made: the sources first, then the environment, then what is compiled."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for time, name in enumerate(["pyproject.toml", *C, ".venv/dev.installed", ".venv/dev.compiled"], start=1000):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
        os.utime(path, (time, time))
    return tmp_path


def make(folder: Path, *arguments: str) -> str:
    """What make prints, as if nobody had called this suite by make: it would hand on its options and its level."""
    alone = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
    return subprocess.run(
        ["make", *arguments], cwd=folder, env=alone, capture_output=True, text=True, check=True
    ).stdout


def planned(tree: Path) -> str:
    """The commands that `make test` would run."""
    return make(tree, "-n", "test")


def test_what_is_there_is_not_made_again(tree: Path) -> None:
    assert planned(tree).strip() == ".venv/bin/python -m pytest -n auto --dist worksteal"


@pytest.mark.parametrize("changed", C)
def test_c_that_has_changed_is_compiled_again(tree: Path, changed: str) -> None:
    os.utime(tree / changed, (2000, 2000))
    commands = planned(tree)
    assert "-m boreprop.kernel\n" in commands
    assert "-m boreprop_fmu.native\n" in commands
    assert "pip install" not in commands


def test_a_new_environment_is_compiled_for(tree: Path) -> None:
    os.utime(tree / "pyproject.toml", (2000, 2000))
    commands = planned(tree)
    assert commands.index("pip install") < commands.index("-m boreprop.kernel\n") < commands.index("pytest")


def test_every_source_is_one_that_make_watches() -> None:
    watched = make(ROOT, "-pn", "clean")
    rules = next(line for line in watched.splitlines() if line.startswith(".venv/%.compiled:"))
    sources = {path for folder in ("model", "fmu_build") for path in (ROOT / folder).rglob("*.[ch]")}
    assert sources == {ROOT / name for name in rules.split()[2:]}
