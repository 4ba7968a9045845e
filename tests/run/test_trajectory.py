"""A run: its columns, its number of stabilizers, and what it says of itself."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from boreprop.errors import InputError
from boreprop.run.trajectory import Trajectory


def test_the_number_of_stabilizers_and_their_columns_in_order(trajectory: Trajectory) -> None:
    without_case = Trajectory(dict(reversed(trajectory.columns.items())))
    assert (trajectory.n, without_case.n, trajectory.row_count) == (2, 2, 5)
    inclinations = without_case.stack("average_inclination")
    np.testing.assert_array_equal(inclinations[:, 0], trajectory["average_inclination[1]"])
    np.testing.assert_array_equal(inclinations[:, 1], trajectory["average_inclination[2]"])
    assert without_case.stack("stabilizer_force").shape == (5, 1)
    one = Trajectory({"drilled_length": np.zeros(5), "average_inclination[1]": np.zeros(5)})
    assert one.stack("stabilizer_force").shape == (5, 0)


def test_a_missing_column_is_named(trajectory: Trajectory) -> None:
    with pytest.raises(InputError, match="must have a column 'stabilizer_force\\[2\\]', got drilled_length, "):
        trajectory["stabilizer_force[2]"]


def test_a_run_is_a_mapping_from_names_to_columns(trajectory: Trajectory) -> None:
    assert isinstance(trajectory, Mapping)
    assert (list(trajectory), len(trajectory)) == (list(trajectory.columns), len(trajectory.columns))
    assert dict(trajectory.items()).keys() == dict(trajectory).keys() == trajectory.columns.keys()
    assert "drilled_length" in trajectory
    assert "depth" not in trajectory
    assert trajectory.get("depth") is None
    with pytest.raises(InputError, match=r"^the run must have a column 'depth', got "):
        trajectory["depth"]


def test_a_run_is_told_in_a_line(trajectory: Trajectory) -> None:
    told = repr(replace(trajectory, stopped="the bit turns over", engine="native"))
    length = trajectory["drilled_length"][-1]
    assert told == (
        f"<Trajectory: {len(trajectory)} columns, {trajectory.row_count} rows over {length:g} m, native engine, "
        "stopped before its end>"
    )
    assert repr(Trajectory(trajectory.columns)).endswith(" m, without its case>")
