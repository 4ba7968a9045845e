"""The repository itself: what its files say of each other and of the machine they were written on."""

import ast
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from places import ROOT

PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
MACHINE = re.compile(
    rb"(?<![\w.])/(?:home|media|mnt|opt|root|tmp|Users|work)/|\b[A-Z]:\\\w{2}|\.\./shared|(?:index|registry)[-_]url|find[-_]links"
)


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def files() -> list[Path]:
    """Every file that is or would be committed."""
    if not (ROOT / ".git").exists():
        pytest.skip("not a git checkout")
    listing = subprocess.run(
        ["git", "-c", f"safe.directory={ROOT}", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        check=True,
    ).stdout
    paths = [ROOT / name for name in listing.decode().split("\0") if name]
    return [path for path in paths if path.is_file()]


def test_no_file_names_a_place_on_a_machine(files: list[Path]) -> None:
    found = {
        str(path.relative_to(ROOT)): [match.group() for match in MACHINE.finditer(path.read_bytes())] for path in files
    }
    assert not {name: matches for name, matches in found.items() if matches}


def test_versions_agree() -> None:
    version = re.escape(PYPROJECT["project"]["version"])
    assert re.search(rf"^version: {version}$", text("CITATION.cff"), re.MULTILINE)
    headings = re.findall(r"^## \[(.+?)\]", text("CHANGELOG.md"), re.MULTILINE)
    assert re.fullmatch(version, next(heading for heading in headings if heading != "Unreleased"))


def test_links_between_documents_lead_somewhere(files: list[Path]) -> None:
    links = [
        (document, target)
        for document in files
        if document.suffix == ".md"
        for target in re.findall(r"\]\(([^)\s#]+)", document.read_text(encoding="utf-8"))
        if "://" not in target
    ]
    assert not [(str(document), target) for document, target in links if not (document.parent / target).exists()]


MOST_LINES, MOST_LINES_OF_A_FUNCTION = 400, 60
PACKAGES = [ROOT / folder for folder in PYPROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]]


def test_source_files_fit_in_the_head() -> None:
    sources = [file for package in PACKAGES for file in package.rglob("*") if file.suffix in {".py", ".c", ".h"}]
    assert len(sources) > 100
    assert not [str(file) for file in sources if len(file.read_text(encoding="utf-8").splitlines()) > MOST_LINES]


def body_lines(function: ast.FunctionDef) -> int:
    """Without its docstring: what a function is given and returns may take many lines to say."""
    statements = function.body[ast.get_docstring(function) is not None :]
    return (statements[-1].end_lineno or 0) - statements[0].lineno + 1 if statements else 0


def test_functions_fit_on_a_screen() -> None:
    long = {
        node.name: body_lines(node)
        for package in PACKAGES
        for file in package.rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef) and body_lines(node) > MOST_LINES_OF_A_FUNCTION
    }
    assert not long
