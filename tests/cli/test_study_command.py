"""The command `boreprop study`."""

import json
from pathlib import Path

import pytest

from conftest import Command, assert_refused

parquet = pytest.importorskip("pyarrow.parquet")


def test_the_command_over_a_grid(command: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 30.0"), encoding="utf-8")
    axes = ["--vary", "eta_pi=0.01:0.02:2", "--vary", "bit_tilt_limit_deg=1,2,95"]
    result = command("boreprop", "study", "case.toml", *axes, "--output", "study.parquet", "--workers", "1")
    assert result.stderr == ""
    assert "median" in result.stdout
    assert "6 cases, 2 failed (the first: bit_tilt_limit: must be <= " in result.stdout
    assert "the figures are of the other 4, " in result.stdout
    assert parquet.read_table(tmp_path / "study.parquet")["bit_tilt_limit_deg"].to_pylist() == [1.0, 2.0, 95.0] * 2


def test_the_command_of_uncertain_parameters(command: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 100.0"), encoding="utf-8")
    arguments = ["--uncertain", "active_weight_on_bit=normal(1600,100)", "--sample", "6", "--seed", "4"]
    result = command("boreprop", "study", "case.toml", *arguments, "--output", "study.parquet", "--workers", "1")
    assert (result.returncode, result.stderr) == (0, "")
    assert "study.parquet: 6 cases, probability of rippling 100.0% (54.1% to 100.0%)" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ([], ("--vary, --uncertain: exactly one", "neither")),
        (["--vary", "eta_pi=1", "--uncertain", "rss_force=normal(0,1)"], ("--vary, --uncertain: exactly one", "both")),
        (["--vary", "eta_pi=1:2"], ("--vary", "START:STOP:COUNT", "'eta_pi=1:2'")),
        (["--vary", "eta_pi"], ("--vary", "START:STOP:COUNT", "'eta_pi'")),
        (["--vary", "eta_pi=1", "--vary", "eta_pi=2"], ("eta_pi: must be given once", "'eta_pi=2'")),
        (["--vary", "weight=1"], ("must be one of", "active_weight_on_bit", "'weight'")),
        (["--uncertain", "eta_pi=gauss(1,2)"], ("--uncertain", "normal(", "'eta_pi=gauss(1,2)'")),
        (["--uncertain", "eta_pi=normal(1)"], ("--uncertain", "normal(", "'eta_pi=normal(1)'")),
        (["--uncertain", "eta_pi=normal(1,-2)"], ("--uncertain", "normal(", "'eta_pi=normal(1,-2)'")),
        (["--uncertain", "eta_pi=triangular(1,1,1)"], ("--uncertain", "triangular(", "'eta_pi=triangular(1,1,1)'")),
        (["--uncertain", "eta_pi=normal(1,2)", "--sample", "0"], ("--sample", "0")),
        (["--vary", "eta_pi=1", "--workers", "0"], ("--workers", "0")),
        (["--vary", "eta_pi=1", "--workers", "1", "--dask", "tcp://a:1"], ("--workers", "--dask", "1")),
        (["--vary", "eta_pi=1", "--dask", "nobody://a:1"], ("--dask", "Dask scheduler", "'nobody://a:1'")),
    ],
)
def test_wrong_arguments_of_the_command(
    command_here: Command, tmp_path: Path, paper_case: Path, arguments: list[str], named: tuple[str, ...]
) -> None:
    result = command_here("boreprop", "study", paper_case, "--output", "study.parquet", *arguments)
    assert (result.returncode, result.stdout) == (2, "")
    assert len(result.stderr.splitlines()) == 1, result.stderr
    for name in named:
        assert name in result.stderr
    assert not list(tmp_path.iterdir())


def test_the_command_goes_on_from_a_csv_file(command_here: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 30.0"), encoding="utf-8")
    arguments = ["study", "case.toml", "--output", "study.csv", "--workers", "1", "--vary"]
    first = command_here("boreprop", *arguments, "rss_force=0,1000")
    assert (first.returncode, first.stderr) == (0, "")
    whole = (tmp_path / "study.csv").read_text(encoding="utf-8")
    (tmp_path / "study.csv").write_text(
        "".join(whole.splitlines(keepends=True)[:2]), encoding="utf-8"
    )  # header, case 0
    assert command_here("boreprop", *arguments, "rss_force=0,1000").stdout == first.stdout
    assert (tmp_path / "study.csv").read_text(encoding="utf-8") == whole
    refused = command_here("boreprop", *arguments, "rss_force=0,2000")
    assert_refused(refused, "study.csv: rss_force of case 1: must be 1000.0", "got 2000.0")


def test_a_study_as_json(command_here: Command, tmp_path: Path, paper_text: str) -> None:
    (tmp_path / "case.toml").write_text(paper_text.replace("= 219.6", "= 5.0"), encoding="utf-8")
    arguments = ["study", "case.toml", "--output", "study.csv", "--workers", "1", "--vary", "bit_tilt_limit_deg=1,2,95"]
    document = json.loads(command_here("boreprop", *arguments, "--json").stdout)
    assert (document["cases"], document["failed"], document["quantiles"]) == (3, 1, [0.0, 0.5, 1.0])
    assert document["first_error"].startswith("bit_tilt_limit: must be <= ")
    rows = [line.split(",") for line in (tmp_path / "study.csv").read_text(encoding="utf-8").splitlines()]
    at = rows[0].index("build_rate")
    low, high = sorted(float(row[at]) for row in rows[1:3])
    assert document["figures"]["build_rate"] == pytest.approx([low, (low + high) / 2, high])
    assert document["figures"]["wavelength"] == [None] * 3  # nothing ripples yet
