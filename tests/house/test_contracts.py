"""The import contract of pyproject.toml holds, and fails when an import breaks it."""

import ast
import os
import shutil
import sys
from pathlib import Path

import pytest

from conftest import Command
from places import ROOT

SOURCE_ROOTS = ("model", "fmu_build", "viz")

DOWNWARDS = "Arrows run downwards: viewer, FMU, model"
IN_MODEL = "Arrows run downwards inside the model"
IN_FMU = "Arrows run downwards inside the FMU's package"
CIRCLES = "No circles"
MODEL = "The model knows nothing of FMI and Rerun"
CORE = "The core, which travels inside the FMU, needs the standard library only"
VIEWER = "The viewer draws whatever gives rows: FMUs are its command's business"


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the packages that lint-imports finds before the installed ones."""
    for root in SOURCE_ROOTS:
        shutil.copytree(ROOT / root, tmp_path / root, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(str(tmp_path / root) for root in SOURCE_ROOTS))
    return tmp_path


def test_the_contract_holds(copy: Path, command: Command) -> None:
    result = command("lint-imports", "--no-cache")
    assert result.returncode == 0, result.stdout
    for contract in (DOWNWARDS, IN_MODEL, IN_FMU, CIRCLES, MODEL, CORE, VIEWER):
        assert f"{contract} KEPT" in result.stdout


@pytest.mark.parametrize(
    ("package", "statement", "contract"),
    [
        ("model/boreprop", "import fmpy", MODEL),
        ("model/boreprop", "import pythonfmu", MODEL),
        ("model/boreprop", "def late():\n    import rerun", MODEL),
        ("model/boreprop", "import boreprop_fmu", DOWNWARDS),
        ("fmu_build/boreprop_fmu", "import boreprop_viz", DOWNWARDS),
        ("model/boreprop/core", "import numpy", CORE),
        ("model/boreprop/run", "from ..analysis import summary", IN_MODEL),
        ("model/boreprop/core", "from .. import errors", IN_MODEL),
        ("model/boreprop/analysis", "from ..report.tables import summary", IN_MODEL),
        ("fmu_build/boreprop_fmu/host", "from ..cli import app", IN_FMU),
        ("model/boreprop/analysis/stability", "from .. import tipping", CIRCLES),
        ("fmu_build/boreprop_fmu/host", "from boreprop_fmu import pack", IN_FMU),
        ("viz/boreprop_viz", "import boreprop_fmu", VIEWER),
    ],
)
def test_the_contract_fails_when(copy: Path, command: Command, package: str, statement: str, contract: str) -> None:
    with (copy / package / "__init__.py").open("a", encoding="utf-8") as file:
        file.write(f"\n{statement}\n")
    result = command("lint-imports", "--no-cache")
    assert result.returncode == 1, result.stdout
    assert f"{contract} BROKEN" in result.stdout


def absolute_imports(module: Path) -> set[str]:
    """The top-level names of the packages that a module imports absolutely."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.partition(".")[0])
    return names


@pytest.mark.parametrize("module", sorted((ROOT / "model/boreprop/core").glob("*.py")), ids=lambda path: path.name)
def test_core_imports_relatively_or_from_the_standard_library(module: Path) -> None:
    assert absolute_imports(module) <= sys.stdlib_module_names
