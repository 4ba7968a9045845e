"""What several tests of the native FMU need."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException

from boreprop.case.case import Case
from conftest import Pack
from flavours import NATIVE
from fmu_host import Instance, instance

DISCARD, ERROR = 2, 3


@pytest.fixture(scope="module")
def borehole(case: Case, pack: Pack) -> Path:
    """The paper's case as machine code for this machine."""
    return pack(case, NATIVE)


@pytest.fixture
def one(borehole: Path) -> Iterator[Instance]:
    """An instance of it."""
    with instance(str(borehole)) as made:
        yield made


@contextmanager
def refused(one: Instance, message: str, status: int = ERROR) -> Iterator[None]:
    """What is done inside ends with a status and logs one line that begins like this."""
    one.log.clear()
    with pytest.raises(FMICallException) as caught:
        yield
    [(level, category, line)] = one.log
    assert (caught.value.status, level, category) == (status, *(NATIVE.discard if status == DISCARD else NATIVE.error))
    assert line.startswith(message)


def ramp(one: Instance, **derivatives: float) -> None:
    references = [one.variables[name].valueReference for name in derivatives]
    one.slave.setRealInputDerivatives(references, [1] * len(references), list(derivatives.values()))
