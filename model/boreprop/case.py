"""A case: what is drilled, with what, from where, under which steering force. Read from and written to TOML.

The file speaks the field's language (long names, degrees), a `Case` the core's (SI, radians). What the file must look
like is in `case_file`, which needs the extra [cli]; a `Case` made in Python needs nothing.
"""

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import degrees, radians
from pathlib import Path
from reprlib import Repr

from .core.assembly import BitRock, BottomHoleAssembly, ParameterError, check_increasing, check_number
from .core.hole import Survey
from .core.tables import TableError, read_columns

SAMPLE_INTERVAL = 0.1  # m between the rows of a run, unless told otherwise: some 50 for each wave of a rippling hole


class InputError(ValueError):
    """What a user gave cannot be used. The message is one line: file, key, constraint, value."""


def shown(value: object) -> str:
    """`value` for an error message: a table by its keys, anything long by its beginning."""
    short = Repr()
    short.maxlist = short.maxtuple = 8
    short.maxstring = short.maxother = 80
    return short.repr(list(value) if isinstance(value, dict) else value)


@dataclass(frozen=True)
class Schedule:
    """The force of the steering pads over the drilled length.

    Parameters
    ----------
    drilled_length
        m from the start of the run: 0, then increasing.
    rss_force
        N, held from each length to the next, the last one to the end. Positive builds.

    Raises
    ------
    ParameterError
        If a value breaks one of these constraints.
    """

    drilled_length: tuple[float, ...] = (0.0,)
    rss_force: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        if not self.drilled_length or self.drilled_length[0] != 0.0:
            raise ParameterError("drilled_length", "must start at 0", self.drilled_length)
        check_increasing("drilled_length", self.drilled_length)
        if len(self.rss_force) != len(self.drilled_length):
            constraint = f"must hold one value per drilled_length, here {len(self.drilled_length)}"
            raise ParameterError("rss_force", constraint, self.rss_force)
        for force in self.rss_force:
            check_number("rss_force", force)


@dataclass(frozen=True)
class Case:
    """One run: the drilling system, the existing hole and the steering force.

    Parameters
    ----------
    bha, bit
        The drilling system.
    bit_diameter
        m, for drawing the hole; no part of the physics.
    active_weight_on_bit
        N.
    length
        Length to drill, m.
    survey
        The existing hole.
    schedule
        The steering force.

    Raises
    ------
    ParameterError
        If one of the three numbers is not positive.
    """

    bha: BottomHoleAssembly
    bit: BitRock
    bit_diameter: float
    active_weight_on_bit: float
    length: float
    survey: Survey
    schedule: Schedule = Schedule()

    def __post_init__(self) -> None:
        for name in ("bit_diameter", "active_weight_on_bit", "length"):
            check_number(name, getattr(self, name), above=0.0)


def load_case(path: str | Path) -> Case:
    """Read a case file; `InputError` if it cannot be read or breaks a constraint."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: must be a readable TOML file, got: {getattr(error, 'strerror', error)}") from error
    return parse_case(text, path)


def parse_case(text: str, source: str | Path) -> Case:
    """The case that `text` (TOML) describes.

    Parameters
    ----------
    text
        The content of a case file.
    source
        Its path: named in errors, and the files that it refers to are looked up beside it.

    Raises
    ------
    InputError
        If the text is no TOML, breaks a constraint, or refers to a file that does.
    """
    from .case_file import parse

    return parse(text, Path(source))


def read_survey(path: str | Path) -> Survey:
    """Read a survey: a CSV file with columns measured_depth (m) and inclination_deg.

    Raises
    ------
    InputError
        If it cannot be read, or the depths do not increase.
    """
    with _naming(path):
        measured_depth, inclination_deg = read_columns(path, ("measured_depth", "inclination_deg"))
        return Survey(measured_depth, tuple(map(radians, inclination_deg)))


def read_schedule(path: str | Path) -> Schedule:
    """Read a force schedule: a CSV file with columns drilled_length (m) and force (N).

    Raises
    ------
    InputError
        If it cannot be read, does not start at 0, or the lengths do not increase.
    """
    with _naming(path):
        return Schedule(*read_columns(path, ("drilled_length", "force")))


@contextmanager
def _naming(path: str | Path) -> Iterator[None]:
    """Turn what is wrong with the columns of a file into an `InputError` that names the file."""
    try:
        yield
    except TableError as error:
        raise InputError(str(error)) from error
    except ParameterError as error:
        raise InputError(f"{path}: {error.name}: {error.constraint}, got {shown(error.value)}") from error


def read_stopped(text: str) -> str | None:
    """Why the run of a case stopped before its end, if the text of the case's file says so."""
    try:
        stopped = tomllib.loads(text).get("run", {}).get("stopped")
    except (tomllib.TOMLDecodeError, AttributeError):
        return None
    return None if stopped is None else str(stopped)


def dump_case(case: Case, stopped: str | None = None) -> str:
    """`case` as the text of a case file that refers to no other file; `parse_case` gives the same case back.

    If its run stopped before its end, the text may say why; `read_stopped` gives that back.
    """
    import tomli_w

    bha, bit = case.bha, case.bit
    run = {} if stopped is None else {"run": {"stopped": stopped}}
    document = {
        "bha": {
            "stabilizer_positions": list(bha.stabilizer_positions),
            "stabilizer_clearances": list(bha.stabilizer_clearances),
            "rss_position": bha.rss_position,
            "distributed_weight": bha.distributed_weight,
            "flexural_stiffness": bha.flexural_stiffness,
        },
        "bit": {
            "lateral_steering_resistance": bit.lateral_steering_resistance,
            "angular_steering_resistance": bit.angular_steering_resistance,
            "tilt_limit_deg": _file_degrees(bit.tilt_limit),
            "diameter": case.bit_diameter,
        },
        "drilling": {"active_weight_on_bit": case.active_weight_on_bit, "length": case.length},
        "hole": {
            "measured_depth": list(case.survey.measured_depth),
            "inclination_deg": list(map(_file_degrees, case.survey.inclination)),
        },
        "rss": {"drilled_length": list(case.schedule.drilled_length), "force": list(case.schedule.rss_force)},
    }
    return tomli_w.dumps(document | run)


def _file_degrees(angle: float) -> float:
    """The degrees that a person would have written for `angle`, rad, if there are such; else the nearest."""
    short = round(degrees(angle), 10)
    return short if radians(short) == angle else degrees(angle)
