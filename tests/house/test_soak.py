"""What `make soak` does with tests and fuzzers that pass, fail and take too long."""

import sys
from pathlib import Path

import pytest

import soak

PASSES, FAILS = [sys.executable, "-c", "pass"], [sys.executable, "-c", "raise SystemExit(1)"]
SPACES = ("wide", "as-built")
PROPERTY = """
import time
from hypothesis import given, strategies as st

@given(st.integers())
def test_property({arguments}):
    {body}

def test_without_examples():
    raise AssertionError
"""


def soaked(monkeypatch: pytest.MonkeyPatch, properties: list[str], fuzzer: list[str], minutes: str = "10") -> int:
    monkeypatch.setattr(soak, "PROPERTIES", properties)
    monkeypatch.setattr(soak, "FUZZERS", [[*fuzzer, space] for space in SPACES])
    monkeypatch.setattr(soak, "ROUNDS", 2)
    return soak.main(["--minutes", minutes, "--seed", "7"])


def pytest_of(tmp_path: Path, body: str) -> list[str]:
    """The command of the soak, on one property test beside one that is none."""
    (tmp_path / "test_it.py").write_text(PROPERTY.format(arguments="number", body=body))
    (tmp_path / "conftest.py").write_text(
        "import hypothesis\nhypothesis.settings.register_profile('soak', database=None, deadline=None)\n"
    )
    return [
        *soak.PROPERTIES[:3],
        *soak.PROPERTIES[5:],
        "-p",
        "no:cacheprovider",
        "--rootdir",
        str(tmp_path),
        str(tmp_path),
    ]


def test_it_is_green_where_all_pass(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert soaked(monkeypatch, pytest_of(tmp_path, "assert number == number"), PASSES) == 0
    told = capfd.readouterr().out
    assert "soak: 10 minutes, seed 7" in told
    assert "2 × the examples" in told
    assert "all green" in told
    assert told.count("1 passed") == 2


def test_a_failing_property_is_named_with_the_seed_of_its_round(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert soaked(monkeypatch, pytest_of(tmp_path, "assert number < 100"), PASSES) == 1
    told = capfd.readouterr().out
    assert "number=100" in told
    assert "--hypothesis-seed=7\n" in told
    assert "soak: failed, seed 7" in told


def test_a_failing_fuzzer_is_named_with_its_seed(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert soaked(monkeypatch, PASSES, FAILS) == 1
    told = capfd.readouterr().out
    for space in SPACES:
        assert f" {space} --minutes " in told
    assert told.count("--seed 7\n") == 2


def test_a_round_that_lasts_too_long_is_cut_and_is_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert soaked(monkeypatch, pytest_of(tmp_path, "time.sleep(60.0)"), PASSES, minutes="0.03") == 0
    assert "0 × the examples" in capfd.readouterr().out


def test_a_soak_takes_time(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        soak.main(["--minutes", "0"])
    assert "--minutes: must be > 0, got 0" in capsys.readouterr().err
