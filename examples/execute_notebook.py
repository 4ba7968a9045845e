"""Run a notebook from top to bottom in a new kernel and keep its outputs in its file.

What a live viewer leaves there shows nothing without its kernel, and is left out, as is what differs between machines.

    python examples/execute_notebook.py examples/rippling.ipynb
"""

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

from boreprop.replacing import replacing

WIDGET = "application/vnd.jupyter.widget-view+json"


def execute(path: Path) -> nbformat.NotebookNode:
    """The notebook with the outputs of a run in its folder; `CellExecutionError` if a cell fails."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(
        notebook,
        kernel_name="python3",
        resources={"metadata": {"path": str(path.parent)}},
        coalesce_streams=True,
        record_timing=False,
        store_widget_state=False,
    ).execute()
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if WIDGET not in output.get("data", {})]
    notebook.metadata.pop("widgets", None)
    notebook.metadata.language_info = {"name": "python"}
    return notebook


if __name__ == "__main__":
    for name in sys.argv[1:]:
        executed = execute(Path(name))
        with replacing(Path(name)) as draft:
            nbformat.write(executed, draft)
