"""What a system simulation relies on: an FMU runs its own code only, keeps its state, refuses what is bad and goes on.

Every FMU runs in a process of its own, see fmu_trust_host.py.
"""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from functools import partial
from math import inf, nan
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

import boreprop
import boreprop_fmu
from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.core.quantities import BY_NAME
from boreprop.core.system import BottomHoleAssembly
from conftest import Pack
from flavours import LOGGED, NATIVE, PYTHON, Flavour, both_flavours
from places import HOSTS
from scenarios import report

SOURCES = {"boreprop": boreprop.__file__, "boreprop_fmu": boreprop_fmu.__file__}


host = partial(report, "fmu_trust_host")


def assert_close(row: dict[str, float], expected: dict[str, float], tolerance: float) -> None:
    """Every value within `tolerance` of its own size, or of its nominal one."""
    for name, value in row.items():
        scale = max(BY_NAME[name.partition("[")[0]].nominal, abs(expected[name]))
        assert abs(value - expected[name]) <= tolerance * scale, name


def version(folder: Path, name: str, case: Path, flavour: Flavour) -> Path:
    """The FMU that another version of our code packs, see hosts/versions. The packages stay beside it."""
    for package, init in SOURCES.items():
        shutil.copytree(Path(init).parent, folder / package, ignore=shutil.ignore_patterns("__pycache__", "binaries"))
    changed = HOSTS / "versions" / f"{name}_{flavour}"
    for path in filter(Path.is_file, changed.rglob("*.*")):
        place = folder / path.relative_to(changed)
        place.rename(place.with_stem(f"{place.stem}_before"))
        shutil.copy(path, place)
    program = (
        "import sys; from pathlib import Path; from boreprop.kernel.compiler import host_platform\n"
        "from boreprop_fmu.native.binaries import binary_path, compile_binary\n"
        "if sys.argv[3] == 'native': compile_binary(binary_path(host_platform()), None)\n"
        "from boreprop_fmu.pack.build import build_fmu; from boreprop import load_case\n"
        "build_fmu(load_case(Path(sys.argv[1])), Path(sys.argv[2]), runtime=sys.argv[3])"
    )
    fmu = folder / "Borehole.fmu"
    quickly = {"CFLAGS": "-O0", "LD_PRELOAD": ""}  # also where the tests have a sanitizer
    environment = {**os.environ, **quickly, "PYTHONPATH": str(folder)}
    subprocess.run([sys.executable, "-c", program, case, fmu, flavour.runtime], env=environment, check=True)
    return fmu


@pytest.fixture(scope="module")
def fmu_3(case: Case, flavour: Flavour, pack: Pack) -> Path:
    """With three stabilizers."""
    bha = BottomHoleAssembly((3.0, 6.5, 11.0), (2e-3, 4e-3), 0.5, 1100.0, 8e6)
    return pack(replace(case, bha=bha), flavour)


@pytest.fixture(scope="module")
def section(paper_case: Path, flavour: Flavour, pack: Pack) -> Path:
    """The build section of the examples."""
    return pack(load_case(paper_case.with_name("build_section.toml")), flavour)


@pytest.fixture(scope="module")
def heavy(paper_case: Path, flavour: Flavour, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Packed from another version of the core, in which gravity bends more."""
    return version(tmp_path_factory.mktemp("heavy"), "heavy", paper_case, flavour)


@pytest.fixture(scope="module")
def loud(paper_case: Path, flavour: Flavour, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Packed from another version of the slave only, which shows every Real output ten times as large."""
    return version(tmp_path_factory.mktemp("loud"), "loud", paper_case, flavour)


# own code only


@both_flavours
def test_each_of_several_versions_in_one_process_runs_the_code_it_carries(
    fmu: Path, fmu_3: Path, heavy: Path, loud: Path
) -> None:
    fmus = [fmu, heavy, loud, fmu_3, fmu]
    rows = host("together", *fmus)
    assert rows == [host("together", path)[0] for path in fmus]
    assert rows[0] != rows[1]
    real = "bit_inclination"
    assert [10 * row[real] for row in rows[0]] == [row[real] for row in rows[2]]


def test_a_host_that_has_imported_other_packages_of_our_names_changes_nothing(fmu: Path, heavy: Path) -> None:
    for fmus in ([fmu, heavy], [heavy, fmu]):
        invaded = host("invaded", heavy.parent, *fmus)
        assert invaded["rows"] == [host("together", path)[0] for path in fmus]
        assert invaded["undisturbed"]


@both_flavours
def test_twenty_instances_at_once_do_not_know_of_each_other(flavour: Flavour, fmu: Path) -> None:
    crowd = host("crowd", fmu, 20)
    assert crowd["rows"] == 20 * host("together", fmu)
    assert crowd["modules"] == flavour.modules


def test_threads_with_an_instance_each_do_not_know_of_each_other(case: Case, pack: Pack) -> None:
    alone, together = host("threads", pack(case, NATIVE), 8)
    assert together == alone
    assert len({rows[-1]["bit_inclination"] for rows in alone}) == 8


def test_both_flavours_give_the_same_in_one_process(fmu: Path, case: Case, pack: Pack) -> None:
    python, native = host("together", fmu, pack(case, NATIVE))
    for row, expected in zip(native, python, strict=True):
        assert_close(row, expected, 1e-9)


@both_flavours
def test_five_hundred_instances_one_after_the_other_are_the_same_and_leave_nothing(flavour: Flavour, fmu: Path) -> None:
    same, growth = host("reborn", fmu, 500)
    assert same
    assert growth < flavour.leak_of_instances


@both_flavours
def test_it_lives_on_where_its_folder_is_gone(fmu: Path) -> None:
    assert host("homeless", fmu) == [["discard"], True, 3.5]


def imported(fmu: Path) -> set[str]:
    """Names of the modules and packages that an FMU brings."""
    with zipfile.ZipFile(fmu) as archive:
        return {Path(name).parts[1].removesuffix(".py") for name in archive.namelist() if name.endswith(".py")}


def test_every_name_an_fmu_imports_carries_a_hash(fmu: Path) -> None:
    names = imported(fmu)
    assert len(names) == 3
    assert all(len(name.rpartition("_")[2]) == 16 for name in names)


def test_names_of_packed_modules_follow_their_content(fmu: Path, heavy: Path, loud: Path) -> None:
    same = {name for name in imported(fmu) if name.startswith("boreprop_slave_base_")}  # pythonfmu's
    assert len(same) == 1
    for one, other in ((fmu, heavy), (fmu, loud), (heavy, loud)):
        assert imported(one) & imported(other) == same


# states


@both_flavours
def test_going_on_from_a_state_is_bit_identical_after_a_kilometre(section: Path, tmp_path: Path) -> None:
    first, restored, deserialized = host("far", section, tmp_path / "state")
    assert first == restored
    assert first == deserialized
    assert first == host("far_again", section, tmp_path / "state")
    assert 1000 < first[-1]["drilled_length"] < 1010
    assert len({row["stabilizer_force[1]"] for row in first}) > 10
    assert (tmp_path / "state").stat().st_size < 60_000  # the hole behind the BHA is forgotten


@both_flavours
def test_no_step_is_done_from_a_state_that_is_not_whole_and_ones_own(
    flavour: Flavour, fmu: Path, fmu_3: Path, heavy: Path, loud: Path
) -> None:
    reports = host("spoilt_states", fmu, fmu_3, heavy, loud)
    assert len(reports) > 110
    step, becomes = flavour.after_bad_state
    for name, refused, lines, levels, outputs, steps, recovered in reports:
        assert [line.partition(",")[0] for line in lines] == ["state: must be one of this FMU"], name
        assert levels == [[3, "logStatusError"]], name
        assert (refused, outputs) == (flavour.wrong_call, becomes), name
        assert steps == [step] * 3, name
        assert recovered, name


def test_a_state_remembers_that_it_is_not_to_be_trusted(fmu: Path) -> None:
    assert host("faulty_state", fmu) == ["ok", "discard"]


@both_flavours
def test_a_state_remembers_that_the_parameters_are_bad(flavour: Flavour, fmu: Path) -> None:
    assert host("systemless_state", fmu) == ["ok", flavour.without_system[1]]


# steps


@both_flavours
@pytest.mark.parametrize("rate", [1.0, 0.37, 0.005])
def test_how_the_way_is_cut_does_not_matter(fmu_3: Path, rate: float) -> None:
    whole, *cut = host("cuts", fmu_3, 7, rate)
    for rows in cut:
        for row, expected in zip(rows, whole, strict=True):
            assert_close(row, expected, 1e-12)


@both_flavours
def test_only_the_inputs_at_the_start_of_a_step_count(fmu: Path) -> None:
    direct, detour = host("changed_inputs", fmu)
    assert direct == detour


# errors


@both_flavours
def test_a_bad_value_is_logged_once_and_moves_nothing(fmu: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        description = fromstring(archive.read("modelDescription.xml"))
    categories = {category.get("name") for category in description.findall("LogCategories/Category")}
    assert "logStatusDiscard" in categories
    reports = host("bad_values", fmu)
    assert len(reports) == 16
    for name, value, status, log, under, unmoved, again in reports:
        assert (status, again) == ("discard", "ok"), name
        [(level, category, message)] = log
        assert (level, category) == LOGGED["discard"]
        assert message.startswith(f"{name}: must be ")
        assert message.endswith(f", got {value!r}")
        if name == "active_weight_on_bit" and value == 0.0:
            assert under == "changed"  # bad with progress only: they are those of a bit off bottom
        else:
            uses_it = name in ("rss_force", "active_weight_on_bit")
            assert under == ("unknown" if uses_it else "kept"), name
        assert unmoved, name


def assert_said(logs: list[list[list[Any]]], statuses: list[str]) -> None:
    """Each of three calls has logged the same line once, with its status; pythonfmu's first one is ok all the same."""
    [message] = {line for log in logs for _, _, line in log}
    assert logs == [[[*LOGGED["error" if status == "ok" else status], message]] for status in statuses]


@both_flavours
def test_a_bad_parameter_stops_the_instance_until_a_reset(flavour: Flavour, fmu: Path) -> None:
    bad: dict[str, list[float]] = {
        "flexural_stiffness": [-1.0, 0.0, inf],
        "distributed_weight": [-1.0],
        "rss_position": [-1.0, 100.0],
        "relative_tolerance": [0.0, 1.0],
        "stabilizer_position[1]": [-3.0, 1e3],
        "stabilizer_clearance[1]": [-1e-3],
    }
    reports = host("bad_parameters", fmu, json.dumps([[name, value] for name in bad for value in bad[name]]))
    assert len(reports) == 11
    for name, value, statuses, logs, again in reports:
        initialized, stepped = flavour.without_system
        assert (statuses, again) == ([initialized, stepped, stepped], "ok"), name
        assert_said(logs, [initialized, stepped, stepped])
        [(_, _, message)] = logs[0]
        assert message.startswith(name.partition("[")[0])
        assert ": must " in message
        assert ", got " in message
        assert repr(value) in message


@both_flavours
def test_what_is_bad_is_named_with_the_constraint_and_the_value(fmu: Path) -> None:
    apart = "must be at least 0.01 m from each other and from the bit"
    messages = {
        ("flexural_stiffness", -1.0): "flexural_stiffness: must be > 0, got -1.0",
        ("stabilizer_position[1]", 50.0): "stabilizer_position: must increase, got (50.0, 7.32)",
        ("stabilizer_position[1]", 7.315): f"stabilizer_position: {apart}, got (7.315, 7.32)",
        ("stabilizer_position[1]", 0.005): f"stabilizer_position: {apart}, got (0.0, 0.005)",
        ("relative_tolerance", nan): "relative_tolerance: must be ",
        # what a survey file is called is no format for the logger's printf
        ("survey_file", "no/%s%n.csv"): "no/%%s%%n.csv: must be a readable CSV file",
    }
    reports = host("bad_parameters", fmu, json.dumps(list(messages)))
    for message, (_, value, _, logs, _) in zip(messages.values(), reports, strict=True):
        assert logs[0][0][2].startswith(message), value


@both_flavours
def test_a_survey_file_that_cannot_be_used_stops_the_instance_until_a_reset(
    flavour: Flavour, fmu: Path, tmp_path: Path
) -> None:
    texts = {
        "empty.csv": b"",
        "columns.csv": b"depth,inclination\n1,2\n",
        "binary.csv": bytes(range(256)),
        "backwards.csv": b"measured_depth,inclination_deg\n2,0\n1,0\n",
        "text.csv": b"measured_depth,inclination_deg\n2,steep\n",
        "nan.csv": b"measured_depth,inclination_deg\n2,nan\n",
        "stations.csv": b"measured_depth,inclination_deg\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_bytes(text)
    (tmp_path / "folder.csv").mkdir()
    paths = [str(tmp_path / name) for name in (*texts, "folder.csv", "missing.csv")]
    reports = host("bad_parameters", fmu, json.dumps([["survey_file", path] for path in paths]))
    for path, (_, _, statuses, logs, again) in zip(paths, reports, strict=True):
        initialized, stepped = flavour.without_system
        assert (statuses, again) == ([initialized, stepped, stepped], "ok"), path
        assert_said(logs, [initialized, stepped, stepped])
        [(_, _, message)] = logs[-1]
        assert message.startswith(path)
        assert " must " in message
        assert message.endswith("(survey_file)")


def test_an_exception_that_nobody_foresaw_is_no_fatal_error(paper_case: Path, tmp_path: Path) -> None:
    mined = version(tmp_path, "mined", paper_case, PYTHON)
    at_once, log, good_input, good_state, reset = host("unforeseen", mined)
    assert (at_once, good_input, good_state, reset) == ("discard", "discard", "ok", "ok")
    assert log == ["state: must be set to a good one or reset, got ZeroDivisionError: float division by zero"]


@both_flavours
@pytest.mark.slow
def test_thousands_of_bad_calls_of_each_kind_leave_neither_crash_nor_leak(flavour: Flavour, fmu: Path) -> None:
    growth, statuses, again = host("endure", fmu, 4_000)
    assert again == "ok"
    assert statuses == {
        "wrong_value": ["discard"],
        "wrong_step": ["discard"],
        "wrong_state": [f"{flavour.wrong_call}, {flavour.after_bad_state[0]}"],
        "wrong_reference": [f"{flavour.wrong_call}, {flavour.after_bad_call}"],
        "right_state": ["ok"],
    }
    assert max(growth.values()) < flavour.leak, growth
    assert growth["right_state"] < 1e6


# nothing but the standard library


def test_a_whole_life_needs_the_standard_library_only(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(tmp_path)
    command = [sys.executable, "-I", "-S", str(HOSTS / "fmu_bare_life.py"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["statuses"] == [0] * len(report["statuses"])
    assert report["repeated"]
    assert report["refused"] == 2
    assert report["log"] == ["rss_force: must be a finite number, got nan"]
    assert report["drilled"] == [20.0, 20.0]
    assert report["foreign"] == []
