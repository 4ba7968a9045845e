"""The kernel from Python: the same runs as `core.drilling`, in compiled code, through ctypes."""

import ctypes
import re
from functools import cache
from typing import Any

import numpy as np

from ..arrays import Floats
from ..core.checks import check_number
from ..core.drilling import check_inputs, check_tolerance
from ..core.errors import BorepropError, ParameterError
from ..core.propagation import RELATIVE_TOLERANCE
from ..core.quantities import OUTPUTS, scalar_names
from ..core.survey import Survey
from ..core.system import MAX_STABILIZERS, BitRock, BottomHoleAssembly
from .compiler import library_path, sources_digest

MESSAGE = 512


class KernelError(BorepropError):
    """The kernel is not there. The message says why, and what helps."""


class System(ctypes.Structure):
    """The parameters of the table of variables, as in assembly.h."""

    _fields_ = (
        ("n", ctypes.c_int),
        ("stabilizer_position", ctypes.c_double * MAX_STABILIZERS),
        ("stabilizer_clearance", ctypes.c_double * (MAX_STABILIZERS - 1)),
        ("rss_position", ctypes.c_double),
        ("distributed_weight", ctypes.c_double),
        ("flexural_stiffness", ctypes.c_double),
        ("lateral_steering_resistance", ctypes.c_double),
        ("angular_steering_resistance", ctypes.c_double),
        ("bit_tilt_limit", ctypes.c_double),
        ("relative_tolerance", ctypes.c_double),
    )


class Inputs(ctypes.Structure):
    """What acts from where the bit is, as in drilling.h."""

    _fields_ = (
        ("rss_force", ctypes.c_double),
        ("rss_force_slope", ctypes.c_double),
        ("active_weight_on_bit", ctypes.c_double),
    )


def numbers(values: Any, kind: Any = np.float64) -> Any:
    """An array as the kernel takes it."""
    return np.ascontiguousarray(values, dtype=kind)


@cache
def library() -> ctypes.CDLL:
    """The kernel, loaded.

    Raises
    ------
    KernelError
        If it is not built, cannot be loaded, or is older than its sources.
    """
    path = library_path()
    helps = "with a C compiler, or after pip install ziglang, run: python -m boreprop.kernel"
    if not path.exists():
        raise KernelError(f"the native kernel must be built, got no {path.name}: {helps}")
    try:
        kernel = ctypes.CDLL(str(path))
    except OSError as error:
        raise KernelError(f"{path.name} must be loadable, got: {error}: {helps}") from error
    kernel.boreprop_sources_digest.restype = ctypes.c_char_p
    if kernel.boreprop_sources_digest().decode() != sources_digest():
        raise KernelError(f"{path.name} must be made from the sources beside it, got an older one: {helps}")
    run, reals, whole, text = ctypes.c_void_p, _array(np.float64), ctypes.c_longlong, ctypes.c_char_p
    for name, result, arguments in (
        ("start", run, (ctypes.POINTER(System), whole, reals, reals, ctypes.POINTER(Inputs), text)),
        ("end", None, (run,)),
        ("follow", whole, (run, whole, reals, reals, ctypes.c_double, _array(np.intc), reals, text)),
        ("outputs", ctypes.c_int, (run, reals)),
        ("length", ctypes.c_double, (run,)),
        ("step", None, (run, reals)),
        ("state_size", whole, (run,)),
        ("save", None, (run, reals)),
        ("restore", ctypes.c_int, (run, reals, whole, text)),
    ):
        function = getattr(kernel, f"boreprop_{name}")
        function.restype, function.argtypes = result, arguments
    return kernel


def _array(kind: Any) -> Any:
    return np.ctypeslib.ndpointer(kind, flags="C_CONTIGUOUS")


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def available() -> bool:
    """Whether the kernel is there."""
    try:
        library()
    except KernelError:
        return False
    return True


class NativeDrilling:
    """A borehole as it is drilled, like `core.drilling.Drilling`: parameters, units and numbers are the same.

    Raises
    ------
    ParameterError
        If an input or the tolerance is out of range, or a dimensionless number made of them is not finite.
    KernelError
        If the kernel is not there.
    """

    def __init__(
        self,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        *,
        active_weight_on_bit: float,
        rss_force: float = 0.0,
        relative_tolerance: float = RELATIVE_TOLERANCE,
    ) -> None:
        check_inputs(rss_force, active_weight_on_bit)
        check_tolerance(relative_tolerance)
        n = len(bha.stabilizer_positions)
        system = System(
            n,
            bha.stabilizer_positions,
            bha.stabilizer_clearances,
            bha.rss_position,
            bha.distributed_weight,
            bha.flexural_stiffness,
            bit.lateral_steering_resistance,
            bit.angular_steering_resistance,
            bit.tilt_limit,
            relative_tolerance,
        )
        self.drilled_length = 0.0
        self._names = scalar_names(OUTPUTS, n)
        self._why = ctypes.create_string_buffer(MESSAGE)
        self._library = library()
        self._run = self._library.boreprop_start(
            system,
            len(survey.measured_depth),
            numbers(survey.measured_depth),
            numbers(survey.inclination),
            Inputs(rss_force, 0.0, active_weight_on_bit),
            self._why,
        )
        if not self._run:
            told = re.fullmatch("(.+?): (.+), got (.+)", self._message())
            if told is None:
                raise ParameterError("parameters", "must give a finite state", self._message())
            name, constraint, value = told.groups()
            raise ParameterError(name, constraint, _number(value))

    def __del__(self) -> None:
        if getattr(self, "_run", None):
            self._library.boreprop_end(self._run)

    def advance(self, drilled_length: float, rss_force: float, active_weight_on_bit: float) -> str | None:
        """Drill on under inputs held from here, as `Drilling.advance`."""
        check_inputs(rss_force, active_weight_on_bit)
        check_number("drilled_length", drilled_length, at_least=self.drilled_length)
        nowhere = np.empty(0)
        return self.follow(numbers([drilled_length]), numbers([rss_force]), active_weight_on_bit, [-1], nowhere)

    def follow(
        self, lengths: Floats, forces: Floats, active_weight_on_bit: float, rows: Any, table: Floats
    ) -> str | None:
        """Drill leg after leg.

        Parameters
        ----------
        lengths
            Where the legs end, m from the start of the run, (legs,), not decreasing.
        forces
            The RSS force along each, N, (legs,).
        active_weight_on_bit
            N.
        rows
            Which row of `table` the outputs at the end of each leg become, (legs,); −1: none.
        table
            (…, outputs), C-contiguous, in the order of the table of variables.

        Returns
        -------
        str | None
            None, or what the next leg met; then the bit is where the one before ended.

        Raises
        ------
        ValueError
            If the arrays do not fit together.
        """
        legs, rows = len(lengths), numbers(rows, np.intc)
        if not len(forces) == len(rows) == legs or (rows >= len(table)).any():
            raise ValueError(f"forces, rows: must be {legs}, of a table of {len(table)}, got {len(forces)}, {rows}")
        if len(table) and table.shape != (len(table), len(self._names)):
            raise ValueError(f"table: must have {len(self._names)} columns, got shape {table.shape}")
        done = self._library.boreprop_follow(
            self._run, legs, lengths, forces, active_weight_on_bit, rows, table, self._why
        )
        if done:
            self.drilled_length = float(lengths[done - 1])
        return None if done == legs else self._message()

    def outputs(self) -> dict[str, float | int]:
        """Every output where the bit is, as `Drilling.outputs`."""
        row = np.empty(len(self._names))
        self._library.boreprop_outputs(self._run, row)
        return dict(zip(self._names, row.tolist(), strict=True))

    def step(self) -> Floats:
        """ξ, h and end of the integrator's present step, the part whose bound it meets there (−1: none) and on which
        side; how many steps were accepted and rejected so far, and how many bounds met.
        """
        found = np.empty(8)
        self._library.boreprop_step(self._run, found)
        return found

    def save(self) -> Floats:
        """The whole evolving state."""
        state = np.empty(self._library.boreprop_state_size(self._run))
        self._library.boreprop_save(self._run, state)
        return state

    def restore(self, state: Floats) -> None:
        """Go back to a state from `save` of a run with the same parameters; `ParameterError` if it cannot be one."""
        if not self._library.boreprop_restore(self._run, state, len(state), self._why):
            raise ParameterError("state", "must be one of this system", len(state))
        self.drilled_length = self._library.boreprop_length(self._run)

    def _message(self) -> str:
        return self._why.value.decode()
