"""The kernel from Python, through ctypes: the same runs as those of `core.drilling`, in compiled code."""

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, Unpack

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..core.errors import BorepropError, ParameterError, error_of
from ..core.ground import Ground, check_step
from ..core.inputs import Slopes, slopes_of
from ..core.options import Options, Statistics
from ..core.problems import SENTENCES, Problem
from ..core.quantities import ACTING, OUTPUTS, SLOPES, Structure, scalar_names, values_of
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly, check_in_plane
from .compiler import library_path, sources_digest
from .generate import NAMES, SYSTEM, quantities_digest

PLANAR, SPATIAL = "boreprop_", "boreprop_space_"  # how the names of functions begin
CODES, QUANTITIES = ("", *SENTENCES), ("", *NAMES.values())  # by their numbers in problems.h


class KernelError(BorepropError, RuntimeError):
    """The kernel cannot be used. The message says why, and what helps."""


class Inputs(ctypes.Structure):
    """The inputs, as in quantities.h."""

    _fields_ = tuple((name, ctypes.c_double) for name in ACTING)


class OptionsInC(ctypes.Structure):
    """How the integrator takes its steps, as in quantities.h."""

    _fields_ = tuple((field.name, ctypes.c_double) for field in fields(Options))


class ProblemInC(ctypes.Structure):
    """What is wrong, as in checks.h."""

    _fields_ = tuple(
        (field.name, ctypes.c_double if field.type is float else ctypes.c_int) for field in fields(Problem)
    )

    def read(self) -> Problem:
        """The same as a `Problem`."""
        code, quantity, *rest = (getattr(self, field.name) for field in fields(Problem))
        return Problem(CODES[code], QUANTITIES[quantity], *rest)


def numbers(values: Any, kind: Any = np.float64) -> Any:
    """An array as the kernel takes it."""
    return np.ascontiguousarray(values, dtype=kind)


@cache
def library() -> ctypes.CDLL:
    """The kernel, loaded.

    Raises
    ------
    KernelError
        If it is not built, cannot be loaded, or was made from other sources or for another table of quantities.
    """
    return load(library_path())


def load(path: Path) -> ctypes.CDLL:
    """The kernel in a file, if it is one for this table of quantities; `KernelError` if not."""
    helps = "with a C compiler or ziglang (pip install ziglang==0.15.2) run: python -m boreprop.kernel"
    if not path.exists():
        raise KernelError(f"the native kernel must be built, got no {path.name}: {helps}")
    try:
        kernel = ctypes.CDLL(str(path))
    except OSError as error:
        raise KernelError(f"{path.name} must be loadable, got: {error}: {helps}") from error
    kernel.boreprop_sources_digest.restype = ctypes.c_char_p
    if kernel.boreprop_sources_digest().decode() != sources_digest():
        raise KernelError(f"{path.name} must be made from the sources beside it, got an older one: {helps}")
    kernel.boreprop_quantities_digest.restype = ctypes.c_char_p
    if kernel.boreprop_quantities_digest().decode() != quantities_digest():
        helps = "run: python -m boreprop.kernel.generate, then: python -m boreprop.kernel"
        raise KernelError(f"{path.name} must be made for this table of quantities, got another one's: {helps}")
    for prefix in (PLANAR, SPATIAL):
        _declare(kernel, prefix)
    return kernel


def _declare(kernel: ctypes.CDLL, prefix: str) -> None:
    """Say what the functions with a prefix take and return."""
    run, reals, indices, whole = ctypes.c_void_p, _array(np.float64), _array(np.intc), ctypes.c_longlong
    table = np.ctypeslib.ndpointer(np.float64, ndim=2)
    own = ctypes.POINTER(ctypes.c_double)
    inputs, options, problem = (ctypes.POINTER(struct) for struct in (Inputs, OptionsInC, ProblemInC))
    for name, result, arguments in (
        ("sentence", None, (problem, ctypes.c_char_p)),
        ("start", run, (indices, reals, options, whole, *3 * (reals,), ctypes.c_int, own, inputs, problem)),
        ("end", None, (run,)),
        ("follow", whole, (run, whole, reals, reals, indices, indices, table, whole, whole, problem)),
        ("outputs", ctypes.c_int, (run, reals)),
        ("length", ctypes.c_double, (run,)),
        ("change_clearances", ctypes.c_int, (run, reals, problem)),
        ("step", ctypes.c_int, (run, problem)),
        ("statistics", None, (run, reals)),
        ("state_size", whole, (run,)),
        ("save", None, (run, reals)),
        ("restore", ctypes.c_int, (run, reals, whole, problem)),
    ):
        function = getattr(kernel, prefix + name)
        function.restype, function.argtypes = result, arguments
    both = (ctypes.c_double, ctypes.c_double)
    kernel.boreprop_lie.restype = whole
    kernel.boreprop_lie.argtypes = (
        *(_array(np.intc), reals, *both, whole, reals, reals, whole, reals, reals, problem),
    )


def _array(kind: Any) -> Any:
    return np.ctypeslib.ndpointer(kind, flags="C_CONTIGUOUS")


def why_not() -> str:
    """Why the kernel cannot be used, and what helps; empty if it can."""
    try:
        library()
    except KernelError as error:
        return str(error)
    return ""


def available() -> bool:
    """Whether the kernel can be used."""
    return not why_not()


class Lie(NamedTuple):
    """How a BHA lies in a hole, row by row: `lie`."""

    forces: Floats  # of the wall on each support, N, (rows, supports)
    bit_force: Floats  # F_0, N, (rows,)
    bit_moment: Floats  # M = −M_0, N·m, (rows,)
    shape: Floats  # distance from the bit's axis at the places that were asked for, m, (rows, places)


def lie(
    bha: BottomHoleAssembly,
    offsets: Floats,
    rss_force: Floats,
    sine: Floats,
    *,
    weight_on_bit: float = 0.0,
    inclination: float = 0.0,
    places: Floats | tuple[float, ...] = (),
) -> Lie:
    """How a BHA lies in holes that are given, with its contacts found.

    Parameters
    ----------
    bha
        The BHA, with whatever it has of sections, axial load and points of the body.
    offsets
        Of the bit's axis from the axis of the hole at each support, e of eq. (5), m, (rows, supports): at the n
        stabilizers, then at the points of the body.
    rss_force
        N, (rows,).
    sine
        Of the inclination at which the weight acts across: of θ with `axial_load`, else of ⟨Θ⟩_1, (rows,).
    weight_on_bit
        All of it, N, for a BHA with `axial_load`.
    inclination
        At which the weight acts along such a BHA, rad.
    places
        Increasing distances from the bit at which the shape is asked for, m, (places,).

    Raises
    ------
    ParameterError
        If the BHA buckles under the weight.
    CannotContinue
        If no contacts are found.
    """
    names = scalar_names(SYSTEM, bha.structure)
    given = dict.fromkeys(names, 1e-3) | values_of("bha", bha)  # the bit has no say: any one will do
    loads = numbers(np.column_stack([offsets, rss_force, sine]))
    rows, width = loads.shape
    answers, shapes, problem = np.empty_like(loads), np.empty((rows, len(places))), ProblemInC()
    done = library().boreprop_lie(
        numbers(bha.structure, np.intc),
        numbers([given[name] for name in names]),
        weight_on_bit,
        inclination,
        rows,
        loads,
        answers,
        len(places),
        numbers(places),
        shapes,
        problem,
    )
    if done < rows:
        raise error_of(problem.read())
    return Lie(answers[:, : width - 2], answers[:, -2], answers[:, -1], shapes)


class NativeDrilling:
    """A borehole as it is drilled. Parameters, units, numbers and errors are those of `core.drilling.Drilling`.

    Raises
    ------
    KernelError
        If the kernel cannot be used.
    """

    def __init__(
        self,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        *,
        active_weight_on_bit: float,
        rss_force: float = 0.0,
        weight_on_bit: float = 0.0,
        options: Options = Options(),  # noqa: B008 - frozen
        ground: Ground | None = None,
    ) -> None:
        check_in_plane(bit)
        acting = {"rss_force": rss_force, "active_weight_on_bit": active_weight_on_bit, "weight_on_bit": weight_on_bit}
        azimuth = np.zeros(len(survey.measured_depth))
        self._start(PLANAR, bha.structure, bha, bit, survey, azimuth, acting, options, ground)

    def _start(
        self,
        prefix: str,
        structure: Structure,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        azimuth: Floats,
        acting: Mapping[str, float],
        options: Options,
        ground: Ground | None,
    ) -> None:
        structure = structure._replace(layered=int(ground is not None and bool(ground.tops)))
        layers = None if ground is None else numbers(ground.numbers)
        given = values_of("bha", bha) | {"relative_tolerance": options.relative_tolerance}
        self.bit, self.ground = bit, ground
        self._names = scalar_names(OUTPUTS, structure)
        self._clearances = len(bha.stabilizer_clearances)
        self._problem = ProblemInC()
        self._library, self._prefix = library(), prefix
        self._run = self._call("start")(
            numbers(structure, np.intc),
            numbers([given[name] for name in scalar_names(SYSTEM, structure)]),
            OptionsInC(**vars(options)),
            len(survey.measured_depth),
            numbers(survey.measured_depth),
            numbers(survey.inclination),
            numbers(azimuth),
            0 if ground is None else len(ground.tops),
            None if layers is None else layers.ctypes.data_as(ctypes.POINTER(ctypes.c_double)),
            Inputs(**acting, **values_of("bit", bit)),
            self._problem,
        )
        self._check(self._run)

    def __del__(self) -> None:
        if getattr(self, "_run", None):
            self._call("end")(self._run)

    def _call(self, name: str) -> Callable[..., Any]:
        function: Callable[..., Any] = getattr(self._library, self._prefix + name)
        return function

    def _check(self, done: object) -> None:
        """Unless a call is done, raise the error for the problem that the kernel has found."""
        if not done:
            raise error_of(self._problem.read())

    @property
    def drilled_length(self) -> float:
        """Where the bit is, m from the start of the run."""
        return float(self._call("length")(self._run))

    @property
    def statistics(self) -> Statistics:
        """What the integrator has done since the start of the run."""
        counts = np.empty(len(Statistics._fields))
        self._call("statistics")(self._run, counts)
        return Statistics(*map(int, counts))

    def advance(
        self,
        drilled_length: float,
        rss_force: float,
        active_weight_on_bit: float,
        *,
        weight_on_bit: float = 0.0,
        bit: BitRock | None = None,
        **slopes: Unpack[Slopes],
    ) -> None:
        """Drill on under inputs from here, constant or linear in the drilled length, as `Drilling.advance`."""
        forces = {"rss_force": rss_force, "active_weight_on_bit": active_weight_on_bit, "weight_on_bit": weight_on_bit}
        self._advance(drilled_length, forces, bit, slopes)

    def _advance(self, drilled_length: float, forces: Mapping[str, float], bit: BitRock | None, slopes: Slopes) -> None:
        acting = {**forces, **values_of("bit", bit or self.bit), **dict(zip(SLOPES, slopes_of(slopes), strict=True))}
        inputs = [[acting.get(name, 0.0) for name in ACTING]]
        self.follow([drilled_length], inputs, [-1], np.empty((0, len(self._names))))

    def follow(
        self,
        lengths: Floats | list[float],
        inputs: Floats | list[list[float]],
        rows: NDArray[np.intc] | list[int],
        table: Floats,
        which: NDArray[np.intc] | None = None,
    ) -> None:
        """Drill leg after leg, as `Drilling.follow`; `ValueError` if the arrays do not fit together."""
        legs, on_rows, given = len(lengths), numbers(rows, np.intc), numbers(inputs)
        acting = np.arange(len(given), dtype=np.intc) if which is None else numbers(which, np.intc)
        fit = given.shape == (len(given), len(ACTING)) and ((0 <= acting) & (acting < len(given))).all()
        if not fit or len(acting) != legs or len(on_rows) != legs or (on_rows >= len(table)).any():
            constraint = f"must hold {legs} times {', '.join(ACTING)}, like lengths, and rows below {len(table)}"
            raise ValueError(f"inputs, rows: {constraint}, got shape {given.shape} and rows {on_rows.tolist()}")
        if table.shape != (len(table), len(self._names)):
            raise ValueError(f"table: must have {len(self._names)} columns, got shape {table.shape}")
        down, across = (stride // table.itemsize for stride in table.strides)
        done = self._call("follow")(
            self._run, legs, numbers(lengths), given, acting, on_rows, table, down, across, self._problem
        )
        self._check(done == legs)

    def change_clearances(self, clearances: tuple[float, ...]) -> None:
        """Let the stabilizers have other clearances, m, from where the bit is, as `Drilling.change_clearances`."""
        if len(clearances) != self._clearances:
            raise ParameterError("stabilizer_clearance", f"must hold {self._clearances} values", clearances)
        self._check(self._call("change_clearances")(self._run, numbers(clearances), self._problem))

    def step(self) -> None:
        """Drill on to the end of the integrator's next step, as `Drilling.step`."""
        check_step(self.ground)
        self._check(self._call("step")(self._run, self._problem))

    def outputs(self) -> dict[str, float | int]:
        """Every output where the bit is, as `Drilling.outputs`."""
        row = np.empty(len(self._names))
        self._call("outputs")(self._run, row)
        return dict(zip(self._names, row.tolist(), strict=True))

    def save(self) -> Floats:
        """The whole evolving state, an array of numbers."""
        state = np.empty(self._call("state_size")(self._run))
        self._call("save")(self._run, state)
        return state

    def restore(self, state: Floats) -> None:
        """Go back to a state from `save` of a run with the same parameters; `ParameterError` if it cannot be one."""
        self._check(self._call("restore")(self._run, state, len(state), self._problem))
