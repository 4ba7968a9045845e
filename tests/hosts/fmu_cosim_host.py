"""The borehole in libcosim, a C++ importer: alone, and connected to a second FMU. In a process of its own.

python fmu_cosim_host.py SCENARIO ARGUMENT … → JSON on the last line of stdout
"""

import json
import os
import sys
from typing import Any

from fmpy import read_model_description
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

from fmu_host import instance

NANOSECONDS = 1_000_000_000
READ = ["drilled_length", "bit_inclination", "borehole_inclination", "stabilizer_force[1]", "displacement"]


def references(fmu: str) -> dict[str, int]:
    """Value references by name."""
    return {v.name: v.valueReference for v in read_model_description(fmu).modelVariables}


def rows_of(execution: Any, observer: Any, index: int, fmu: str, steps: int) -> list[list[float]]:
    """`READ` and the contact after each step."""
    reference = references(fmu)
    rows = []
    for _ in range(steps):
        assert execution.step()
        reals = observer.last_real_values(index, [reference[name] for name in READ])
        contact = observer.last_integer_values(index, [reference["stabilizer_contact[1]"]])
        rows.append([*reals, *contact])
    return rows


def alone(fmu: str, step: str, steps: str) -> object:
    """Rows under a force that is set at the start and again on the way."""
    reference = references(fmu)
    execution = CosimExecution.from_step_size(int(float(step) * NANOSECONDS))
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="borehole"))
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    execution.real_initial_value(index, reference["rss_force"], 2e3)
    rows = rows_of(execution, observer, index, fmu, int(steps))
    manipulator.slave_real_values(index, [reference["rss_force"]], [-3e3])
    return rows + rows_of(execution, observer, index, fmu, int(steps))


def alone_in_fmpy(fmu: str, step: str, steps: str) -> object:
    """The same in fmpy."""
    with instance(fmu) as one:
        one.initialize(rss_force=2e3)
        rows = one.steps(int(steps), float(step))
        one.set(rss_force=-3e3)
        rows += one.steps(int(steps), float(step))
    return [[row[name] for name in [*READ, "stabilizer_contact[1]"]] for row in rows]


def connected(fmu: str, steering: str, step: str, steps: str) -> object:
    """Rows of the borehole with the bit's inclination fed back through the second FMU."""
    execution = CosimExecution.from_step_size(int(float(step) * NANOSECONDS))
    borehole = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="borehole"))
    controller = execution.add_local_slave(CosimLocalSlave(fmu_path=steering, instance_name="steering"))
    here, there = references(fmu), references(steering)
    execution.connect_real_variables(borehole, here["bit_inclination"], controller, there["inclination"])
    execution.connect_real_variables(controller, there["force"], borehole, here["rss_force"])
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    return rows_of(execution, observer, borehole, fmu, int(steps))


def connected_in_fmpy(fmu: str, steering: str, step: str, steps: str) -> object:
    """The same in fmpy: both step at once, then exchange, as libcosim's fixed-step algorithm does."""
    size, rows = float(step), []
    with instance(fmu) as borehole, instance(steering) as controller:
        for one in (borehole, controller):
            one.initialize()
        for _ in range(int(steps)):
            controller.set(inclination=borehole.get("bit_inclination"))
            borehole.set(rss_force=controller.get("force"))
            assert borehole.step(size) == controller.step(size) == "ok"
            row = borehole.row()
            rows.append([row[name] for name in [*READ, "stabilizer_contact[1]"]])
    return rows


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])), flush=True)
    os._exit(0)  # libcosim does not call pythonfmu's finalizer: at exit its library may drop its static state twice
