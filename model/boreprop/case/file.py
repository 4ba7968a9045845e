"""A case: what is drilled, with what, from where, under which steering force. Read from and written to TOML.

The file speaks the field's language (long names, degrees), a `Case` the core's (SI, radians). `schema` says what the
file must look like.
"""

import tomllib
from collections.abc import Mapping
from math import degrees, radians
from pathlib import Path

import tomli_w

from ..errors import InputError
from .case import Case
from .schema import parse


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
    return parse(text, Path(source))


def read_run(text: str) -> dict[str, str]:
    """What the text of a case file says of a run of the case: "engine", and if it stopped, why as "stopped"."""
    try:
        return {key: str(value) for key, value in tomllib.loads(text).get("run", {}).items()}
    except (tomllib.TOMLDecodeError, AttributeError):
        return {}


def dump_case(case: Case, run: Mapping[str, str] | None = None) -> str:
    """`case` as the text of a case file that refers to no other file; `parse_case` gives the same case back.

    The text may say of a `run` of the case what `read_run` gives back.
    """
    bha, bit = case.bha, case.bit
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
    return tomli_w.dumps(document | ({"run": dict(run)} if run else {}))


def _file_degrees(angle: float) -> float:
    """The degrees that a person would have written for `angle`, rad, if there are such; else the nearest."""
    short = round(degrees(angle), 10)
    return short if radians(short) == angle else degrees(angle)
