"""What all figures share: colours, and how a picture gets into its file."""

from pathlib import Path

from matplotlib.figure import Figure

from ...replacing import replacing

COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")  # Okabe and Ito: told apart by the colour-blind


def save(figure: Figure, path: Path) -> None:
    """Write a picture (PNG); nothing of that name changes before everything is written."""
    with replacing(path) as draft:
        figure.savefig(draft, dpi=150, format="png")
