"""What is generated for C is fresh, and C that does not keep up with the table of quantities is refused."""

import shutil
from dataclasses import astuple, replace
from math import inf, isfinite, nan
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.parameters import parameters
from boreprop.core.checks import check_number
from boreprop.core.errors import ParameterError
from boreprop.core.options import Options
from boreprop.core.problems import Problem
from boreprop.core.quantities import OUTPUTS, Quantity, scalar_names
from boreprop.core.survey import Survey
from boreprop.kernel import binding
from boreprop.kernel.binding import KernelError
from boreprop.kernel.compiler import FOLDER, CompilerError, NoCompilerError, compile_library, sources_digest
from boreprop.kernel.generate import HEADERS, SYSTEM, quantities_header


@pytest.mark.parametrize("name", HEADERS)
def test_the_generated_headers_are_fresh(name: str) -> None:
    assert (FOLDER / name).read_text(encoding="utf-8") == HEADERS[name](), "run: python -m boreprop.kernel.generate"


@pytest.fixture(autouse=True)
def quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compile without optimizing."""
    monkeypatch.setenv("CFLAGS", "-O0")


def compiled(folder: Path, outputs: tuple[Quantity, ...]) -> Path:
    """The kernel, compiled with a header for these outputs."""
    for path in [*FOLDER.glob("*.c"), *FOLDER.glob("*.h")]:
        shutil.copy(path, folder)
    (folder / "quantities.h").write_text(quantities_header(outputs=outputs), encoding="utf-8")
    digest = {"BOREPROP_SOURCES_DIGEST": f'"{sources_digest()}"'}
    try:
        return compile_library(folder / "library.c", folder / "boreprop_kernel.so", defines=digest)
    except NoCompilerError as error:
        pytest.skip(str(error))


def test_an_output_that_c_does_not_compute_is_an_error_of_the_compiler(tmp_path: Path) -> None:
    half_added = Quantity("sensor_torque", "output", "N.m", "", "", "torque at the sensor", size="sensors")
    with pytest.raises(CompilerError, match="OUT_SENSOR_TORQUE"):
        compiled(tmp_path, (*OUTPUTS, half_added))


def test_a_library_for_another_table_is_refused(tmp_path: Path) -> None:
    assert binding.load(compiled(tmp_path, OUTPUTS))
    (tmp_path / "other").mkdir()
    with pytest.raises(KernelError, match="must be made for this table of quantities"):
        binding.load(compiled(tmp_path / "other", OUTPUTS[::-1]))


def started(
    case: Case, changed: dict[str, float], survey: tuple[list[float], list[float]] = ([0.0], [0.0])
) -> Problem | None:
    """The problem that C has with a case in which some parameters are others."""
    given, structure = parameters(case) | {"relative_tolerance": 1e-7} | changed, case.bha.structure
    problem, library = binding.ProblemInC(), binding.library()
    depths, inclinations = (binding.numbers(values) for values in survey)
    run = library.boreprop_start(
        binding.numbers(structure, np.intc),
        binding.numbers([given[name] for name in scalar_names(SYSTEM, structure)]),
        binding.OptionsInC(*astuple(Options())),
        len(depths),
        depths,
        inclinations,
        0,
        None,
        binding.Inputs(rss_force=0.0, active_weight_on_bit=1e3),
        problem,
    )
    library.boreprop_end(run)
    return None if run else problem.read()


def as_built(case: Case) -> Case:
    """A case with two sections of the same beam, two points of the body, and two sensors."""
    bha = replace(
        case.bha,
        section_lengths=(3.0, 5.0),
        section_distributed_weights=(case.bha.distributed_weight,) * 2,
        section_flexural_stiffnesses=(case.bha.flexural_stiffness,) * 2,
        section_outer_diameters=(0.17, 0.17),
        body_point_positions=(2.0, 5.0),
        body_point_clearances=(0.02, 0.02),
        sensor_positions=(2.0, 0.0),
    )
    return replace(case, bha=bha)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("quantity", SYSTEM, ids=lambda quantity: quantity.name)
def test_c_refuses_a_parameter_that_python_refuses_with_the_same_problem(case: Case, quantity: Quantity) -> None:
    case = case if quantity.count(case.bha.structure) else as_built(case)
    scalar, index = quantity.names(case.bha.structure)[-1], quantity.count(case.bha.structure) * quantity.is_list
    bounds = {"above": quantity.above, "at_least": float(quantity.at_least), "at_most": float(quantity.at_most)}
    outside = [
        quantity.above,
        quantity.at_least - 1e-9,
        max(quantity.at_most + 1e-9, np.nextafter(quantity.at_most, inf)),
    ]
    for value in (inf, -inf, nan, *filter(isfinite, outside)):
        with pytest.raises(ParameterError) as refused:
            check_number(quantity.name, float(value), index=index, **bounds)
        assert repr(started(case, {scalar: value})) == repr(refused.value.problem)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("positions", [(3.66, 3.66), (7.32, 3.66), (3.66, 3.669), (0.005, 7.32)])
def test_c_refuses_positions_that_python_refuses_with_the_same_problem(
    case: Case, positions: tuple[float, float]
) -> None:
    with pytest.raises(ParameterError) as refused:
        replace(case.bha, stabilizer_positions=positions, rss_position=0.0)
    first, second = positions
    changed = {"stabilizer_position[1]": first, "stabilizer_position[2]": second, "rss_position": 0.0}
    assert repr(started(case, changed)) == repr(refused.value.problem)


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize(
    ("depths", "inclinations"),
    [([1.0, 1.0], [0.0, 0.0]), ([1.0, nan], [0.0, 0.0]), ([0.0, 1.0], [0.0, inf]), ([1.0, 0.0], [0.0, 0.0])],
)
def test_c_refuses_a_survey_that_python_refuses_with_the_same_problem(
    case: Case, depths: list[float], inclinations: list[float]
) -> None:
    with pytest.raises(ParameterError) as refused:
        Survey(tuple(depths), tuple(inclinations))
    assert repr(started(case, {}, (depths, inclinations))) == repr(refused.value.problem)


@pytest.mark.usefixtures("kernel")
def test_c_refuses_an_empty_survey_in_the_words_of_python(case: Case) -> None:
    problem = started(case, {}, ([], []))
    assert problem
    with pytest.raises(ParameterError) as refused:
        Survey((), ())
    assert problem.sentence == str(refused.value)
