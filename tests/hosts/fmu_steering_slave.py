"""A second FMU for the borehole to be connected to: holds an inclination with a force in proportion to what is missing.

Packed by pythonfmu itself.
"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Steering(Fmi2Slave):  # type: ignore[misc]
    def __init__(self, **kwargs: object) -> None:
        super().__init__(**kwargs)
        self.inclination = 0.0
        self.force = 0.0
        self.register_variable(Real("inclination", causality=Fmi2Causality.input))
        self.register_variable(Real("force", causality=Fmi2Causality.output))

    def do_step(self, current_time: float, step_size: float) -> bool:
        self.force = 1e5 * (0.1 - self.inclination)
        return True
