"""The controller FMU's script: from surveys, the steering force that keeps the hole on its plan.

The plan is straight, then builds at a constant rate, then holds. The inclination is measured `sensor_distance` behind
the bit, so it is compared with the plan there, every `survey_interval`. In between the force is held:

    F = holding_force + plan's build rate / steering_response    feed-forward: what the model says
      + proportional_gain · e + integral_force                   feedback: what the surveys say, e = plan − measured
"""

import sys
from math import floor, isfinite
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu.enums import Fmi2Causality, Fmi2Initial, Fmi2Status, Fmi2Variability
from pythonfmu.fmi2slave import Fmi2Slave
from pythonfmu.variables import Real

VARIABLES = (
    # name, causality, unit, start, meaning
    ("inclination", "input", "rad", 0.0, "last reading of the sensor"),
    ("drilled_length", "input", "m", 0.0, "where the bit is, from the start of the run"),
    ("rss_force", "output", "N", 0.0, "steering force, positive builds"),
    ("start_inclination", "parameter", "rad", 0.0, "plan: inclination of the straight hole before the build"),
    ("build_rate", "parameter", "rad/m", 0.0, "plan: build rate"),
    ("build_length", "parameter", "m", 0.0, "plan: drilled length at which the build ends; must be set"),
    ("survey_interval", "parameter", "m", 10.0, "drilled length between surveys"),
    ("sensor_distance", "parameter", "m", 0.0, "distance of the sensor from the bit"),
    ("steering_response", "parameter", "rad/(m.N)", 1.105e-7, "build rate per force, for the feed-forward"),
    ("steering_lead", "parameter", "m", 0.0, "length whose build a force gives at once, for the feed-forward"),
    ("holding_force", "parameter", "N", 0.0, "force that holds the inclination, for the feed-forward"),
    ("proportional_gain", "parameter", "N/rad", 2.26e5, "force per error"),
    ("integral_length", "parameter", "m", 150.0, "length over which a constant error adds as much again"),
    ("force_limit", "parameter", "N", 15e3, "largest force of the actuator, either way"),
    ("integral_force", "local", "N", 0.0, "state: the integral part of the force"),
    ("next_survey", "local", "m", 0.0, "state: drilled length of the next survey"),
)
UNITS = {
    "m": {"m": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/rad": {"kg": 1, "m": 1, "s": -2, "rad": -1},
    "rad": {"rad": 1},
    "rad/m": {"rad": 1, "m": -1},
    "rad/(m.N)": {"rad": 1, "kg": -1, "m": -2, "s": 2},
}
HOW = {
    "input": (Fmi2Variability.continuous, None),
    "output": (Fmi2Variability.discrete, Fmi2Initial.calculated),
    "parameter": (Fmi2Variability.fixed, Fmi2Initial.exact),
    "local": (Fmi2Variability.discrete, Fmi2Initial.calculated),
}
POSITIVE = {"survey_interval", "steering_response", "integral_length", "force_limit"}
CLOSE = 1e-6  # m: a survey this much early is in time


class InclinationController(Fmi2Slave):
    """PI controller with feed-forward, actuator limit and anti-windup. All of its state are FMI variables."""

    description = "Steering force from surveys: PI on the inclination, feed-forward of the plan"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        for name, causality, _, start, meaning in VARIABLES:
            setattr(self, name, start)
            variability, initial = HOW[causality]
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality[causality],
                    variability=variability,
                    initial=initial,
                    description=meaning,
                )
            )

    def enter_initialization_mode(self) -> None:
        """Before the first survey there is the feed-forward; without a plan, or with a bad value, no force at all."""
        self.next_survey = self.survey_interval
        if not self.fault():
            self.rss_force = self.limited(self.feed_forward(0.0))

    def exit_initialization_mode(self) -> None:
        """The same again, since hosts may set parameters in between; by now there must be a plan."""
        self.enter_initialization_mode()
        if fault := self.fault():  # many hosts show no log; there the first step says it again, and is discarded
            print(f"{self.instance_name}: {fault}", file=sys.stderr)

    def do_step(self, current_time: float, step_size: float) -> bool:  # noqa: ARG002
        """Take a survey at the beginning of the step if one is due. With a bad value the step is discarded."""
        fault = self.fault()
        if fault:
            self.log(fault, Fmi2Status.error, "logStatusError")
            return False
        if self.drilled_length >= self.next_survey - CLOSE:
            self.next_survey = self.survey_interval * (1 + floor((self.drilled_length + CLOSE) / self.survey_interval))
            self.take_survey()
        return True

    def fault(self) -> str:
        """One line that says which value cannot be used; empty: none. An exception would be fatal to the host's run."""
        for name, *_ in VARIABLES:
            value = getattr(self, name)
            if not isfinite(value):
                return f"{name}: must be finite, got {value}"
            if name in POSITIVE and value <= 0.0:
                return f"{name}: must be > 0, got {value}"
        if self.build_length <= 0.0:
            plan = "start_inclination (rad), build_rate (rad/m) and build_length (m, > 0)"
            return f"plan: must be given by the parameters {plan}, got a build_length of {self.build_length}"
        return ""

    def take_survey(self) -> None:
        """New force from the present measurement."""
        error = self.planned(self.drilled_length - self.sensor_distance) - self.inclination
        proportional = self.proportional_gain * error
        wanted = self.feed_forward(self.drilled_length) + proportional + self.integral_force
        self.rss_force = self.limited(wanted)
        if (wanted - self.rss_force) * error <= 0.0:  # anti-windup: integrate only what the actuator can still give
            self.integral_force += proportional * self.survey_interval / self.integral_length

    def planned(self, drilled_length: float) -> float:
        """The plan's inclination there, rad."""
        return self.start_inclination + self.build_rate * min(max(drilled_length, 0.0), self.build_length)

    def feed_forward(self, drilled_length: float) -> float:
        """The force for the plan from here to the next survey, N: later by what a change of force gives at once."""
        start = drilled_length - self.steering_lead
        turn = self.planned(start + self.survey_interval) - self.planned(start)
        return self.holding_force + turn / self.survey_interval / self.steering_response

    def limited(self, force: float) -> float:
        """What the actuator gives of `force`, N."""
        return min(max(force, -self.force_limit), self.force_limit)

    def to_xml(self, *arguments: Any) -> Element:
        """The model description, with the units and dependencies that pythonfmu leaves out."""
        root = super().to_xml(*arguments)
        definitions = Element("UnitDefinitions")
        root.insert(1, definitions)
        for name, base in UNITS.items():
            unit = SubElement(definitions, "Unit", name=name)
            SubElement(unit, "BaseUnit", {symbol: str(exponent) for symbol, exponent in base.items()})
        for scalar, (_, _, unit_name, _, _) in zip(root.iterfind("ModelVariables/*"), VARIABLES, strict=True):
            scalar[0].set("unit", unit_name)
        output = root.find("ModelStructure/Outputs/Unknown")
        output.set("dependencies", "")  # the force answers to the last survey, not to the present inputs
        SubElement(SubElement(root.find("ModelStructure"), "InitialUnknowns"), "Unknown", index=output.get("index"))
        return root
