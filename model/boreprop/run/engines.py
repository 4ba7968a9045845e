"""The engines that drill a case, behind one protocol: the model in Python, and the same as compiled code."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol, Unpack

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case
from ..core.drilling import Drilling
from ..core.errors import CannotContinue, ParameterError
from ..core.ground import Ground
from ..core.inputs import Slopes
from ..core.options import Options, Statistics
from ..core.quantities import ACTING, TOOLFACE_REFERENCES, values_of
from ..core.system import BitRock
from ..kernel.binding import NativeDrilling, available, why_not
from ..kernel.space import SpaceDrilling
from .trajectory import Stopped


class Engine(Protocol):
    """A borehole as it is drilled. `core.drilling.Drilling` says what each method does.

    Bad inputs raise `ParameterError`, an obstacle on the way `CannotContinue`; nothing has changed then. The same
    problem has the same code, quantity, index, value, place and sentence with every engine.
    """

    bit: BitRock

    @property
    def drilled_length(self) -> float:
        """Where the bit is, m from the start of the run."""

    @property
    def statistics(self) -> Statistics:
        """What the integrator has done since the start of the run."""

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
        """Drill on under inputs from here, constant or linear in the drilled length."""

    def follow(
        self,
        lengths: Floats,
        inputs: Floats,
        rows: NDArray[np.intc],
        table: Floats,
        which: NDArray[np.intc] | None = None,
    ) -> None:
        """Drill leg after leg, and write outputs into rows of a table."""

    def change_clearances(self, clearances: tuple[float, ...]) -> None:
        """Let the stabilizers have other clearances, m, from where the bit is."""

    def step(self) -> None:
        """Drill on to the end of the integrator's next step."""

    def outputs(self) -> dict[str, float | int]:
        """Every output where the bit is."""

    def save(self) -> Any:
        """The whole evolving state, for `restore` of a run with the same parameters and the same engine."""

    def restore(self, state: Any) -> None:
        """Go back to a state."""


DRILLING: dict[str, Callable[..., Engine]] = {"native": NativeDrilling, "python": Drilling}
ENGINES = ("auto", *DRILLING)


def held(legs: int, rss_force: float | Floats, weight: float, bit: BitRock, weight_on_bit: float = 0.0) -> Floats:
    """Inputs, N, that are constant along each leg, as `Engine.follow` takes them, (legs, inputs).

    `weight` is the active weight on bit, `weight_on_bit` all of it, for a BHA with `axial_load`; 0: the active one.
    """
    inputs = np.zeros((legs, len(ACTING)))
    acting = {"rss_force": rss_force, "active_weight_on_bit": weight, "weight_on_bit": weight_on_bit}
    for name, value in (acting | values_of("bit", bit)).items():
        inputs[:, ACTING.index(name)] = value
    return inputs


def engine() -> str:
    """The engine that "auto" stands for: "native" where it is there, else "python"."""
    return "native" if available() else "python"


def why_not_native() -> str:
    """Why "auto" stands for "python", and what helps; empty if it stands for "native"."""
    return why_not()


def chosen(choice: str, *, in_space: bool = False) -> str:
    """The engine, "native" or "python", that one of `ENGINES` stands for; `ParameterError` if it cannot be used."""
    if choice not in ENGINES:
        raise ParameterError("engine", f"must be {', '.join(ENGINES[:-1])} or {ENGINES[-1]}", choice)
    if in_space and choice == "python":
        raise ParameterError("engine", "must be native for what drills in space", choice)
    return engine() if choice == "auto" and not in_space else "native" if in_space else choice


@contextmanager
def starting() -> Iterator[None]:
    """Turn an obstacle where a run starts into `Stopped`, as are those on its way."""
    try:
        yield
    except CannotContinue as error:
        raise Stopped(f"after 0 m: {error}") from error


@starting()
def start(case: Case, choice: str, options: Options, ground: Ground | None = None) -> Engine:
    """A case before its first step in the plane, under its first force, in some ground; errors as in `simulate`.

    Without ground, bit and rock go on as they are at the start, as analyses of a case have them.
    """
    own = chosen(choice)
    further = {"weight_on_bit": case.weight_on_bit} if own == "native" else {}
    return DRILLING[own](
        case.bha,
        case.bit,
        case.survey,
        active_weight_on_bit=case.active_weight_on_bit,
        rss_force=case.schedule.rss_force[0],
        options=options,
        ground=ground,
        **further,
    )


@starting()
def start_in_space(case: Case, options: Options) -> Engine:
    """A case before its first step in space, in its own ground; errors as in `simulate`."""
    sides = {name: profile.values[0] for name, profile in case.schedule.sides().items()}
    return SpaceDrilling(
        case.bha,
        case.bit,
        case.survey,
        case.survey.azimuth,
        active_weight_on_bit=case.active_weight_on_bit,
        rss_force=case.schedule.rss_force[0],
        rss_toolface=sides["rss_toolface"],
        toolface_reference=TOOLFACE_REFERENCES[int(sides["toolface_reference"])],
        weight_on_bit=case.weight_on_bit,
        options=options,
        ground=case.ground,
    )
