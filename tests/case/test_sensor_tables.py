"""Sensors in a case file, [[sensor]], and the clearance of the body at each of them."""

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.file import dump_case, load_case, parse_case
from boreprop.case.paper import paper_case
from boreprop.case.parameters import parameters, with_parameters
from boreprop.errors import InputError
from boreprop.run.results import read_trajectory, write_trajectory
from boreprop.run.simulate import simulate
from places import EXAMPLES

TWO = """
[[sensor]]
position  = 5
interval  = 3
bias_deg  = 0.1
noise_deg = 0.05
seed      = 7

[[sensor]]
position       = 0.0
body_clearance = 0.02
"""


def with_text(text: str) -> Case:
    """The paper's case with more text in its file."""
    return parse_case(dump_case(paper_case()) + text, Path("case.toml"))


def test_a_case_file_has_sensors_with_angles_in_degrees() -> None:
    bha = with_text(TWO).bha
    assert bha.sensor_positions == (5.0, 0.0)
    assert bha.sensor_intervals == (3.0, 0.0)
    assert bha.sensor_biases == (radians(0.1), 0.0)
    assert bha.sensor_noises == (radians(0.05), 0.0)
    assert bha.sensor_seeds == (7, 0)


def test_a_case_with_sensors_is_written_and_read_back() -> None:
    case = with_text(TWO)
    assert parse_case(dump_case(case), Path("again.toml")) == case
    assert dump_case(case).count("[[sensor]]") == 2
    assert "[[sensor]]" not in dump_case(paper_case())


def test_where_no_diameter_is_known_the_clearance_is_that_of_the_axis() -> None:
    case = with_text(TWO)
    assert case.bha.sensor_body_clearances == (case.bit_diameter / 2, 0.02)


def test_the_clearance_is_that_of_the_section_and_at_a_step_that_of_the_larger_one() -> None:
    case = load_case(EXAMPLES / "pendulum.toml")
    bha = replace(
        case.bha,
        section_lengths=(20.0, 40.0),
        section_outer_diameters=(0.17, 0.15),
        section_distributed_weights=(1300.0, 1000.0),
        section_flexural_stiffnesses=(1e7, 6e6),
        sensor_positions=(3.0, 20.0, 20.1),
    )
    clearances = replace(case, bha=bha).bha.sensor_body_clearances
    np.testing.assert_allclose(clearances, (np.array([0.2286] * 3) - (0.17, 0.17, 0.15)) / 2, atol=1e-15)


def test_parameters_of_a_study_reach_sensors() -> None:
    case = with_parameters(with_text(TWO), {"sensor_position[1]": 2.0, "sensor_seed[1]": 8.0})
    assert (case.bha.sensor_positions, case.bha.sensor_seeds) == ((2.0, 0.0), (8, 0))
    assert parameters(case)["sensor_bias[1]"] == radians(0.1)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_result_files_have_the_columns_of_sensors(tmp_path: Path, suffix: str) -> None:
    if suffix == ".parquet":
        pytest.importorskip("pyarrow")
    run = simulate(with_text(TWO), length=10.0, sample_interval=0.5)
    write_trajectory(run, tmp_path / f"run{suffix}")
    again = read_trajectory(tmp_path / f"run{suffix}")
    assert again.case == run.case
    for name in ("sensor_inclination", "sensor_bending_moment", "sensor_clearance"):
        np.testing.assert_array_equal(again.stack(name), run.stack(name))
        assert again.stack(name).shape == (run.row_count, 2)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[sensor]]\ninterval = 3.0", "sensor[1].position: must be given, got nothing"),
        ("[[sensor]]\nposition = 3.0\nseeds = 1", "sensor[1].seeds: must be one of position, interval"),
        ("[[sensor]]\nposition = '3 m'", "sensor[1].position: must be a number, got '3 m'"),
        ("[[sensor]]\nposition = true", "sensor[1].position: must be a number, got True"),
        ("[[sensor]]\nposition = 3.0\nseed = 1.5", "sensor[1].seed: must be a whole number, got 1.5"),
        ("[[sensor]]\nposition = 3.0\nnoise_deg = 0.1", "sensor[1].interval: must be given with noise_deg"),
        ("[[sensor]]\nposition = 8.0", "sensor[1].position: must be <= 7.32, got 8.0"),
        (TWO + "[[sensor]]\nposition = -1", "sensor[3].position: must be >= 0, got -1"),
        (
            "[[sensor]]\nposition = 3.0\ninterval = 1\nnoise_deg = -0.1",
            "sensor[1].noise_deg: must be >= 0, got -0.1",
        ),
        ("[[sensor]]\nposition = nan", "sensor[1].position: must be a finite number, got nan"),
        ("[sensor]\nposition = 3.0", "sensor: must be tables [[sensor]]"),
        ("[[sensor]]\nposition = 1.0\n" * 9, "sensor.position: must hold at most 8 values"),
    ],
)
def test_what_cannot_be_is_refused_by_its_key(text: str, message: str) -> None:
    with pytest.raises(InputError) as refused:
        with_text(text)
    assert str(refused.value).startswith(f"case.toml: {message}")
