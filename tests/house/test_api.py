"""The public names of boreprop: they are all there, they say what they do, and a case or a run comes first."""

import ast
import subprocess
import sys
from collections.abc import Callable
from inspect import Signature, getdoc, isclass, isfunction, signature
from typing import Any, get_args

import pytest

import boreprop
from places import ROOT
from public_names import ANALYSES, EXPLAINED, OTHERS, PUBLIC

API: Any = boreprop  # for calls that types forbid
SOURCE = ast.parse((ROOT / "model/boreprop/__init__.py").read_text(encoding="utf-8"))


def test_the_api_has_the_names_that_scripts_need() -> None:
    assert {*EXPLAINED, *OTHERS} <= set(boreprop.__all__) == set(dir(boreprop))


def test_types_and_lazy_names_are_the_same() -> None:
    """Each name is imported for type checkers from where it is loaded when a script asks for it."""
    [checked] = [node for node in SOURCE.body if isinstance(node, ast.If)]  # if TYPE_CHECKING
    imports = [node for node in checked.body if isinstance(node, ast.ImportFrom)]
    imported = {alias.name: f"boreprop.{node.module}" for node in imports for alias in node.names}
    loaded = {name: getattr(boreprop, name).__module__ for name in PUBLIC}
    assert imported == loaded


@pytest.mark.parametrize("name", PUBLIC)
def test_a_public_name_says_what_it_is(name: str) -> None:
    assert len(getdoc(getattr(boreprop, name)) or "") > 20


@pytest.mark.parametrize("name", [*ANALYSES, "write_trajectory"])
def test_a_case_or_a_run_comes_first(name: str) -> None:
    first = next(iter(signature(getattr(boreprop, name)).parameters.values())).annotation
    assert {boreprop.Case, boreprop.Trajectory} & {first, *get_args(first)}


def test_public_functions_say_of_what_type_each_parameter_is() -> None:
    for name in boreprop.__all__:
        if isfunction(function := getattr(boreprop, name)):
            described = signature(function)
            assert described.return_annotation is not Signature.empty, name
            for parameter in described.parameters.values():
                assert parameter.annotation is not Signature.empty, f"{name}: {parameter}"
                assert parameter.name in (getdoc(function) or ""), f"{name} does not explain {parameter.name}"


def test_the_package_alone_loads_nothing_slow() -> None:
    """A command pays for what it uses, and a name of the API for its own module."""
    script = "import sys, boreprop; print(*sys.modules, sep='\\n')"
    loaded = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
    assert [name for name in loaded if name.startswith("boreprop")] == ["boreprop"]
    assert not {"numpy", "pydantic", "scipy", "typer"} & set(loaded)


def test_what_goes_wrong_is_one_kind_of_error() -> None:
    from boreprop import errors
    from boreprop.kernel.binding import KernelError
    from boreprop.kernel.compiler import CompilerError
    from boreprop.run.workers import WorkerLost

    others = (KernelError, CompilerError, WorkerLost)
    own = [kind for kind in (*vars(errors).values(), *others) if isclass(kind) and issubclass(kind, Exception)]
    assert len(own) > 5
    assert all(issubclass(kind, boreprop.BorepropError) for kind in own)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda case: API.stability_chart(case, [], [1.0]),
            r"eta_pi: must be a list of at least one value, got \[\]",
        ),
        (lambda case: API.stability_chart(case, [0.1], [[1.0]]), r"lambda2\[1\]: must be a number, got \[1.0\]"),
        (lambda case: API.walk_chart(case, 0.1), r"walk_angle: must be a list, such as \[0.1\], got 0.1"),
        (
            lambda _: API.InputSchedule((0.0,), (("eta_pi", (0.1,)),)),
            "inputs: must be some of rss_force, .*, got 'eta_pi'",
        ),
        (lambda case: API.hysteresis(case, "eta_pi", [], 0.01), "values: must be a list of at least one value"),
        (lambda case: API.hysteresis(case, "eta_pi", [0.2, 0.1], 0.01), r"values: must increase, got \(0.2, 0.1\)"),
        (lambda case: API.sample(case, {"eta_pi": 0.1}, 3, 1), "eta_pi: must be a frozen distribution of scipy.stats"),
        (lambda case: API.grid(case, {"eta_pi": "0.1"}), "eta_pi: must be a list of numbers, got '0.1'"),
        (lambda case: API.find_roots(case, contact="12"), "contact: must be the number of a non-ideal stabilizer"),
        (lambda case: API.critical_dogleg(case, side=0), "side: must be 1 or -1, got 0"),
        (lambda _: API.find_rippling([0.0, 1.0], [0.0]), r"inclination: .* got the shapes \(1,\) for \(2,\)"),
        (
            lambda case: API.study(API.grid(case, {"eta_pi": [0.1]}), workers=0),
            "workers: must be >= 1, got 0",
        ),
        (lambda case: API.simulate(case, length=1.0).stack("depth"), "the run must have a column 'depth', got "),
    ],
)
def test_an_argument_that_cannot_be_is_named(call: Callable[[boreprop.Case], object], message: str) -> None:
    with pytest.raises(boreprop.BorepropError, match=message):
        call(boreprop.paper_case())


@pytest.mark.parametrize(
    "asked",
    [
        lambda case: API.find_roots(case, inclination=30.0),
        lambda case: API.critical_eta_pi(case, inclination=30.0),
        lambda case: API.stability_chart(case, [0.1], [1.0], inclination=30.0),
        lambda case: API.steady_response(case, 1e3, 30.0),
    ],
)
def test_an_inclination_in_degrees_is_refused(asked: Callable[[boreprop.Case], object]) -> None:
    with pytest.raises(boreprop.BorepropError, match=r"^inclination: must be <= 3.14159 rad, got 30.0$"):
        asked(boreprop.paper_case())


def test_another_name_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="'boreprop' has no attribute 'nothing'"):
        boreprop.nothing  # noqa: B018
