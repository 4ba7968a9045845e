"""The commands `boreprop dogleg` and `boreprop hysteresis`."""

from pathlib import Path

import pytest
from matplotlib.image import imread

from conftest import Command


@pytest.mark.slow
def test_the_commands_print_and_draw(command: Command, tmp_path: Path, paper_case: Path) -> None:
    ranges = ["--eta-pi", "0.05:0.15:2", "--clearance-mm", "2:4:2"]
    result = command("boreprop", "dogleg", paper_case, "--output", "map.png", *ranges)
    assert (result.returncode, result.stderr) == (0, "")
    assert "0.43° over 3.66 m (3.5 °/30 m)" in result.stdout
    result = command("boreprop", "hysteresis", paper_case, "--output", "loop.png", "--eta-pi", "0.03:0.15:3")
    assert (result.returncode, result.stderr) == (0, "")
    assert "dies out between ηΠ = 0.12" in result.stdout
    assert "brings it back between ηΠ = 0.03352 (5.404 kN) and" in result.stdout
    for name in ("map.png", "loop.png"):
        assert imread(tmp_path / name)[..., :3].std() > 0.05


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["dogleg", "CASE", "--output", "map.pdf"], ("map.pdf", ".png")),
        (["dogleg", "CASE", "--eta-pi", "0.1:0.05:3"], ("--eta-pi", "START:STOP:COUNT", "'0.1:0.05:3'")),
        (["dogleg", "CASE", "--clearance-mm", "1:2"], ("--clearance-mm", "START:STOP:COUNT", "'1:2'")),
        (["hysteresis", "CASE", "--output", "loop.png"], ("--eta-pi", "--clearance-mm", "neither")),
    ],
)
def test_wrong_arguments_are_one_line(
    command_here: Command, tmp_path: Path, paper_case: Path, arguments: list[str], named: tuple[str, ...]
) -> None:
    result = command_here("boreprop", *(str(paper_case) if argument == "CASE" else argument for argument in arguments))
    assert (result.returncode, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())
