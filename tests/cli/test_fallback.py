"""Commands that fall back to the engine in Python say so, once."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from boreprop.cli.fallback import warn_of_fallback
from boreprop.kernel import binding
from boreprop.run.engines import why_not_native
from conftest import Command

SIMULATE = ["boreprop", "simulate", "CASE", "--output", "run.csv", "--length", "0.5"]
COMMANDS = [
    (SIMULATE, True),
    ([*SIMULATE, "--engine", "python"], False),
    (["boreprop", "dogleg", "CASE", "--limit-deg", "0.001"], True),
    (["boreprop-view", "one.toml", "other.toml", "--save", "run.rrd"], True),
    (["boreprop", "steering", "CASE"], False),
]


@pytest.fixture
def no_kernel(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.setattr(binding, "library_path", lambda: tmp_path / "nowhere.so")
    binding.library.cache_clear()
    warn_of_fallback.cache_clear()
    yield
    monkeypatch.undo()
    binding.library.cache_clear()
    warn_of_fallback.cache_clear()


@pytest.mark.usefixtures("no_kernel")
@pytest.mark.parametrize(
    ("arguments", "falls_back"), COMMANDS, ids=lambda value: " ".join(value) if isinstance(value, list) else ""
)
def test_a_command_that_falls_back_says_so_once(
    command_here: Command, paper_case: Path, paper_text: str, tmp_path: Path, arguments: list[str], falls_back: bool
) -> None:
    for name in ("one.toml", "other.toml"):
        (tmp_path / name).write_text(paper_text.replace("219.6", "0.5"), encoding="utf-8")
    done = command_here(*(str(paper_case) if argument == "CASE" else argument for argument in arguments))
    assert done.returncode == 0
    lines = [line for line in done.stderr.splitlines() if "engine" in line]
    assert len(lines) == falls_back
    for line in lines:
        assert line.startswith("warning: the python engine drills, which is many times slower, since the native kernel")
        assert line.endswith("run: python -m boreprop.kernel")


@pytest.mark.parametrize("arguments", [SIMULATE])
def test_with_the_kernel_there_is_nothing_to_say(command_here: Command, paper_case: Path, arguments: list[str]) -> None:
    if why_not_native():
        pytest.skip("no kernel")
    done = command_here(*(str(paper_case) if argument == "CASE" else argument for argument in arguments))
    assert (done.returncode, done.stderr) == (0, "")
