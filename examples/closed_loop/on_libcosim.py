"""The system on libcosim (C++), through libcosimpy."""

from collections.abc import Iterator
from itertools import compress
from operator import not_

from libcosimpy.CosimEnums import CosimVariableType
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from system import BOREHOLE, System

from boreprop.errors import InputError

NANOSECONDS = 1_000_000_000  # libcosim's times are integers


def steps(system: System, weights: list[float]) -> Iterator[list[float]]:
    """Step the system with libcosim; yield the recorded variables after each step."""
    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_ssp_file(str(system.directory), round(system.step * NANOSECONDS))
    override, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(override)
    execution.add_observer(observer)
    borehole = execution.slave_index_from_instance_name(BOREHOLE)
    variables = {variable.name.decode(): variable for variable in execution.slave_variables(borehole)}
    integer = [variables[name].type == CosimVariableType.INTEGER.value for name in system.recorded]
    references = [variables[name].reference for name in system.recorded]
    integers = list(compress(references, integer))
    reals = list(compress(references, map(not_, integer)))
    for k, weight in enumerate(weights):
        override.slave_real_values(borehole, [variables["active_weight_on_bit"].reference], [weight])
        if not execution.step():
            raise InputError(f"{system.ssp}: at {k * system.step:g} s: libcosim could not step")
        values = {
            True: iter(observer.last_integer_values(borehole, integers)),
            False: iter(observer.last_real_values(borehole, reals)),
        }
        yield [float(next(values[is_integer])) for is_integer in integer]
