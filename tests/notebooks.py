"""Notebooks of the examples: what they print and show, as they are in their files and as they run."""

from pathlib import Path
from runpy import run_path

import nbformat

from places import EXAMPLES


def read(path: Path) -> nbformat.NotebookNode:
    """A notebook as it is in its file."""
    notebook: nbformat.NotebookNode = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    return notebook


def executed(path: Path) -> nbformat.NotebookNode:
    """A notebook after a run in a new kernel."""
    notebook: nbformat.NotebookNode = run_path(str(EXAMPLES / "execute_notebook.py"))["execute"](path)
    return notebook


def outputs(notebook: nbformat.NotebookNode) -> list[nbformat.NotebookNode]:
    """The outputs of all cells."""
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def printed(notebook: nbformat.NotebookNode) -> list[str]:
    """What the cells print."""
    return [output.text for output in outputs(notebook) if output.output_type == "stream"]


def kinds(notebook: nbformat.NotebookNode) -> list[set[str]]:
    """The MIME types of what is shown."""
    return [set(output.data) for output in outputs(notebook) if "data" in output]


def counts(notebook: nbformat.NotebookNode) -> list[int]:
    """The execution counts of the cells."""
    return [cell.execution_count for cell in notebook.cells if cell.cell_type == "code"]
