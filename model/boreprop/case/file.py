"""A case: what is drilled, with what, from where, under which steering force. Read from and written to TOML.

The file speaks the field's language (long names, degrees), a `Case` the core's (SI, radians). What the file must look
like is in `case_file`, which needs the extra [cli]; a `Case` made in Python needs nothing.
"""

import tomllib
from math import degrees, radians
from pathlib import Path

from ..errors import InputError
from .case import Case


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
    from .schema import parse

    return parse(text, Path(source))


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
