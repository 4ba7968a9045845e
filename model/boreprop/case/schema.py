"""What a case file must look like: its tables, keys and types. The ranges are the core's business."""

import tomllib
from difflib import get_close_matches
from math import radians
from pathlib import Path
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import ErrorDetails, PydanticCustomError

from ..core.errors import ParameterError
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly
from ..errors import InputError, shown
from .case import Case, Schedule
from .tables import read_schedule, read_survey


class _Table(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, frozen=True)


class _Bha(_Table):
    stabilizer_positions: list[float]
    stabilizer_clearances: list[float]
    rss_position: float
    distributed_weight: float
    flexural_stiffness: float


class _Bit(_Table):
    lateral_steering_resistance: float
    angular_steering_resistance: float
    tilt_limit_deg: Annotated[float, Field(gt=0.0, le=90.0)]
    diameter: float


class _Drilling(_Table):
    active_weight_on_bit: float
    length: float


class _Columns(_Table):
    """A table of columns, or the name of a file that holds them."""

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        file, *columns = type(self).model_fields
        if self.model_fields_set not in ({file}, set(columns)):
            constraint = f"must hold either {' and '.join(columns)}, or {file}"
            raise PydanticCustomError("one_source", "{constraint}", {"constraint": constraint})
        return self


class _Hole(_Columns):
    survey: str | None = None
    measured_depth: list[float] = []
    inclination_deg: list[float] = []

    def read(self, directory: Path) -> Survey:
        if self.survey is not None:
            return read_survey(directory / self.survey)
        return Survey(tuple(self.measured_depth), tuple(map(radians, self.inclination_deg)))


class _Rss(_Columns):
    schedule: str | None = None
    drilled_length: list[float] = []
    force: list[float] = []

    def read(self, directory: Path) -> Schedule:
        if self.schedule is not None:
            return read_schedule(directory / self.schedule)
        return Schedule(tuple(self.drilled_length), tuple(self.force))


class _Run(_Table):
    """What there is to say of a run of the case: in the case file beside it."""

    engine: str | None = None
    stopped: str | None = None


class _CaseFile(_Table):
    bha: _Bha
    bit: _Bit
    drilling: _Drilling
    hole: _Hole
    rss: _Rss | None = None
    run: _Run | None = None


_TABLES: dict[str, type[_Table]] = {"bha": _Bha, "bit": _Bit, "drilling": _Drilling, "hole": _Hole, "rss": _Rss}
KEYS = {key: f"{table}.{key}" for table, model in _TABLES.items() for key in model.model_fields} | {
    "tilt_limit": "bit.tilt_limit_deg",
    "bit_diameter": "bit.diameter",
    "inclination": "hole.inclination_deg",
    "rss_force": "rss.force",
}
"""Name of a parameter in the core → table and key in the file."""


def parse(text: str, source: Path) -> Case:
    """See `boreprop.case.parse_case`."""
    try:
        file = _CaseFile.model_validate(tomllib.loads(text))
        return _case(file, source.parent)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{source}: must be TOML, got: {error}") from error
    except ValidationError as error:
        raise InputError(f"{source}: {_worst(error)}") from error
    except ParameterError as error:
        table, key = KEYS[error.name].split(".")
        # the core has radians: show what the file says
        value = getattr(getattr(file, table), key) if key.endswith("_deg") else error.value
        raise InputError(f"{source}: {table}.{key}: {error.constraint}, got {shown(value)}") from error


def _case(file: _CaseFile, directory: Path) -> Case:
    bha, bit = file.bha, file.bit
    return Case(
        bha=BottomHoleAssembly(
            tuple(bha.stabilizer_positions),
            tuple(bha.stabilizer_clearances),
            bha.rss_position,
            bha.distributed_weight,
            bha.flexural_stiffness,
        ),
        bit=BitRock(bit.lateral_steering_resistance, bit.angular_steering_resistance, radians(bit.tilt_limit_deg)),
        bit_diameter=bit.diameter,
        active_weight_on_bit=file.drilling.active_weight_on_bit,
        length=file.drilling.length,
        survey=file.hole.read(directory),
        schedule=file.rss.read(directory) if file.rss else Schedule(),
    )


def _worst(error: ValidationError) -> str:
    """The error to mend first, as "TABLE.KEY: CONSTRAINT, got VALUE": a misspelt key rather than what it leaves out."""
    errors = error.errors(include_url=False)
    worst = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    where = ".".join(str(part) for part in worst["loc"] if isinstance(part, str))
    numbers = "".join(f"[{part + 1}]" for part in worst["loc"] if isinstance(part, int))
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    if worst["type"] == "missing":
        return f"{where}: must be given, got nothing{more}"
    return f"{where}{numbers}: {_constraint(worst)}, got {shown(worst['input'])}{more}"


def _constraint(error: ErrorDetails) -> str:
    if error["type"] == "extra_forbidden":
        meant = get_close_matches(str(error["loc"][-1]), [*KEYS, *_TABLES], n=1)
        return "must be a known key" + (f" ({KEYS.get(meant[0], meant[0])}?)" if meant else "")
    if error["type"] == "model_type":
        return "must be a table"
    return error["msg"].replace("Input should", "must")
