"""What several writers of the same file, and one that is interrupted, leave behind."""

import os
from errno import ENOSPC
from pathlib import Path

import pytest

from boreprop.replacing import replacing


def test_two_writers_with_the_same_process_number_leave_one_whole_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "getpid", lambda: 1)  # as in two containers that share a folder
    path = tmp_path / "run.csv"
    with replacing(path) as first:
        first.write_text("one" * 1000)
        with replacing(path) as second:
            second.write_text("two")
        assert path.read_text() == "two"
    assert path.read_text() == "one" * 1000
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_draft_that_is_not_finished_is_removed(tmp_path: Path, error: type[BaseException]) -> None:
    path = tmp_path / "run.csv"
    path.write_text("old")

    def write() -> None:
        with replacing(path) as draft:
            draft.write_text("half")
            raise error

    with pytest.raises(error):
        write()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_write_that_fails_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    with pytest.raises(OSError, match="No space") as caught, replacing(path):
        raise OSError(ENOSPC, "No space left on device")
    assert caught.value.filename == str(path)
    assert not list(tmp_path.iterdir())
