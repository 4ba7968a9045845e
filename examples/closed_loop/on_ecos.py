"""The system on Ecos (C++), through ecospy."""

from collections.abc import Iterator

from ecospy import EcosSimulation
from system import BOREHOLE, PARAMETER_SET, System

from boreprop.core.quantities import quantity_of
from boreprop.errors import InputError


def steps(system: System, weights: list[float]) -> Iterator[list[float]]:
    """Step the system with Ecos; yield the recorded variables after each step."""
    with EcosSimulation(step_size=system.step, ssp_path=str(system.ssp)) as simulation:
        get = {"Integer": simulation.get_integer, "Real": simulation.get_real}
        readers = [(get[quantity_of(name).kind], f"{BOREHOLE}::{name}") for name in system.recorded]
        simulation.init(parameter_set=PARAMETER_SET)
        for k, weight in enumerate(weights):
            simulation.set_real(f"{BOREHOLE}::active_weight_on_bit", weight)
            if simulation.step() <= k * system.step:
                raise InputError(f"{system.ssp}: at {k * system.step:g} s: Ecos could not step")
            yield [float(read(name)) for read, name in readers]
        simulation.terminate()
