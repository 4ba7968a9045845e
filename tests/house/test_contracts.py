"""The import contract of pyproject.toml holds, and fails when an import breaks it."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from places import ROOT

SOURCE_ROOTS = ("model", "fmu_build", "viz")

DOWNWARDS = "Arrows run downwards: viewer, FMU, model"
INSIDE_MODEL = "Arrows run downwards inside the model"
INSIDE_FMU = "Arrows run downwards inside the FMU's package"
CIRCLES = "No circles in any package"
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


def lint(folder: Path) -> "subprocess.CompletedProcess[str]":
    """Look at the imports of a copy, in a process that has imported none of what is installed."""
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8")


def test_the_contract_holds(copy: Path) -> None:
    result = lint(copy)
    assert result.returncode == 0, result.stdout
    for contract in (DOWNWARDS, INSIDE_MODEL, INSIDE_FMU, CIRCLES, MODEL, CORE, VIEWER):
        assert f"{contract} KEPT" in result.stdout


@pytest.mark.parametrize(
    ("module", "statement", "contract"),
    [
        ("model/boreprop/__init__.py", "import fmpy", MODEL),
        ("model/boreprop/__init__.py", "import pythonfmu", MODEL),
        ("model/boreprop/__init__.py", "def late():\n    import rerun", MODEL),
        ("model/boreprop/__init__.py", "import boreprop_fmu", DOWNWARDS),
        ("fmu_build/boreprop_fmu/__init__.py", "import boreprop_viz", DOWNWARDS),
        ("model/boreprop/core/__init__.py", "import numpy", CORE),
        ("model/boreprop/run/__init__.py", "from boreprop import analysis", INSIDE_MODEL),
        ("model/boreprop/analysis/summary.py", "from ..report.tables.summary import lines", INSIDE_MODEL),
        ("model/boreprop/new.py", "", INSIDE_MODEL),
        ("fmu_build/boreprop_fmu/pack/build.py", "from ..host import drive", INSIDE_FMU),
        ("fmu_build/boreprop_fmu/host/drive.py", "from ..pack import build", INSIDE_FMU),
        ("viz/boreprop_viz/__init__.py", "import boreprop_fmu", VIEWER),
        ("model/boreprop/core/linear.py", "def late():\n    from . import beam", CIRCLES),
        ("viz/boreprop_viz/scene.py", "from . import style", CIRCLES),
    ],
)
def test_the_contract_fails_when(copy: Path, module: str, statement: str, contract: str) -> None:
    with (copy / module).open("a", encoding="utf-8") as file:
        file.write(f"\n{statement}\n")
    result = lint(copy)
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
