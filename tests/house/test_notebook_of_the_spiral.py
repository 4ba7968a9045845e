"""The notebook of the spiral says what it computes."""

import pytest

from boreprop.kernel.binding import available
from notebooks import counts, executed, kinds, printed, read
from places import EXAMPLES

NOTEBOOK = EXAMPLES / "spiral.ipynb"


def test_it_is_executed_from_top_to_bottom_and_has_its_picture() -> None:
    committed = read(NOTEBOOK)
    assert counts(committed) == list(range(1, len(counts(committed)) + 1))
    assert kinds(committed) == [{"image/png", "text/plain"}]


@pytest.mark.slow
@pytest.mark.skipif(not available(), reason="the kernel is not built")
def test_it_runs_in_a_new_kernel_and_says_what_is_in_its_file() -> None:
    committed, now = read(NOTEBOOK), executed(NOTEBOOK)
    assert printed(now) == printed(committed)
    assert kinds(now) == kinds(committed)
    assert now.metadata == committed.metadata


def test_it_tells_the_numbers_of_the_discovery() -> None:
    said = "".join(printed(read(NOTEBOOK)))
    for number in ("pitch 5.10 m, radius 21.4 mm", "0.31 per ℓ₁ from the multipliers", "ψ* = 0.236°"):
        assert number in said
