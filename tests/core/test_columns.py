"""Columns of numbers from CSV files."""

from pathlib import Path

import pytest

from boreprop.core.columns import read_columns
from boreprop.core.errors import TableError


def test_columns_come_in_the_order_that_is_asked_for(tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text("a,b,c\n1,2,3\n4,5,6\n")
    assert read_columns(tmp_path / "table.csv", ("c", "a")) == [(3.0, 6.0), (1.0, 4.0)]


@pytest.mark.parametrize("text", ["inf", "nan", "", "one"])
def test_what_is_no_finite_number_is_refused_with_its_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "table.csv").write_text(f"a,b\n1,2\n3,{text}\n")
    with pytest.raises(TableError, match=rf"table.csv:3: b: must be a finite number, got '{text}'"):
        read_columns(tmp_path / "table.csv", ("b",))
