"""What an FMU answers to calls that the standard has rules for, in a process of its own; see fmu_host.py.

python fmu_rules_host.py SCENARIO FMU → JSON on stdout
"""

import json
import sys
from collections.abc import Callable

from fmu_host import Instance, attempt, instance

Answer = tuple[str, list[list[object]]]  # a status, and what was logged: status, category, message


def answer(one: Instance, call: Callable[..., object], *arguments: object) -> Answer:
    one.log.clear()
    status = attempt(call, *arguments)
    return status, [list(line) for line in one.log]


def start(
    one: Instance, values: dict[str, object] | None = None, *, tolerance: float | None = None, stop: float | None = None
) -> Instance:
    """A reset, and an initialization with what a host may say in it."""
    one.slave.reset()
    one.get("eta_pi")  # a host may look at any time
    one.slave.setupExperiment(tolerance=tolerance, stopTime=stop)
    one.set_names(values or {})
    one.slave.enterInitializationMode()
    one.slave.exitInitializationMode()
    one.time = 0.0
    return one


def wrong_order(one: Instance) -> object:
    slave, step = one.slave, one.slave.doStep
    slave.reset()
    answers = [answer(one, step, 0.0, 1.0), answer(one, slave.exitInitializationMode)]
    start(one)
    again = answer(one, slave.enterInitializationMode)
    answers += [again, answer(one, step, 0.0, 1.0), answer(one, step, 0.0, 1.0)]
    slave.terminate()
    late = answer(one, step, 1.0, 1.0)
    return [*answers, late, answer(one, lambda: one.set(rss_force=1.0)), one.get("drilled_length")]


def fixed_parameter(one: Instance) -> object:
    """One is set while stepping, in one call with an input: the answers to that and two steps, and what has changed."""
    start(one)
    references = [one.variables[name].valueReference for name in ("rss_force", "rss_position")]
    before = one.slave.getReal(references)
    answers = [answer(one, one.slave.setReal, references, [7.0, 0.5])]
    answers += [answer(one, one.slave.doStep, 0.0, 1.0), answer(one, one.slave.doStep, one.get("drilled_length"), 1.0)]
    return [answers, one.slave.getReal(references) == before]


def stop_time(one: Instance) -> object:
    start(one, stop=1.0)
    too_far = answer(one, one.slave.doStep, 0.0, 1.5)
    up_to_it = [one.step(0.1) for _ in range(10)]
    beyond = answer(one, one.slave.doStep, one.time, 0.1)
    start(one, stop=1.0)
    return [too_far, up_to_it, beyond, answer(one, one.slave.doStep, 0.0, 1.0 + 5e-10)[0]]


def points(one: Instance) -> object:
    """Steps from where the last one ended, from before, from after, and from as good as there."""
    start(one)
    answers = [answer(one, one.slave.doStep, time, 1.0) for time in (0.0, 0.0, 1.5, 1.0 + 1e-10, 2.0 - 1e-10)]
    return [answers, one.get("drilled_length")]


def tolerance(one: Instance) -> object:
    """The parameter for it, after a host has given one; and the parameter, and what is logged then."""
    taken = [start(one, tolerance=given).get("relative_tolerance") for given in (1e-9, 1e-5, None)]
    one.slave.reset()
    loose = answer(one, lambda: one.slave.setupExperiment(tolerance=1e-3))
    kept = one.get("relative_tolerance")
    one.slave.reset()
    one.set(relative_tolerance=1e-8)
    one.slave.setupExperiment(tolerance=1e-9)
    chosen, own = one.state(), one.get("relative_tolerance")
    one.slave.reset()
    one.set_state(chosen)
    one.slave.setupExperiment(tolerance=1e-9)
    restored = one.get("relative_tolerance")
    rows = [start(one, {"rss_force": 5e3}, tolerance=given).steps(3, 20.0)[-1] for given in (1e-5, 1e-11)]
    return [taken, loose, kept, own, restored, rows[0] != rows[1]]


def silent(one: Instance) -> object:
    """What is logged of an error where the host has asked for no log."""
    one.slave.fmi2FreeInstance(one.slave.component)
    one.slave.instantiate(callbacks=one.slave.callbacks, loggingOn=False)
    start(one)
    return answer(one, one.slave.getReal, [10_000])


def signs(one: Instance) -> object:
    """What is logged of a file whose name has signs that a logger or a host may take for something else."""
    one.slave.reset()
    one.set(survey_file="no/Well #7, #r0#, 5%.csv")
    one.slave.enterInitializationMode()
    return answer(one, one.slave.exitInitializationMode)


def user(one: Instance) -> object:
    """What goes to stderr between two marks: after a bad parameter, and what is wrong later."""
    print("begin", file=sys.stderr, flush=True)
    attempt(start, one)
    attempt(start, one, {"flexural_stiffness": -1.0})
    for _ in range(3):
        attempt(one.slave.doStep, 0.0, 1.0)
    start(one)
    assert one.step(1.0) == "ok"
    one.set(rate_of_penetration=-1.0)
    attempt(one.slave.doStep, 1.0, 1.0)
    print("end", file=sys.stderr, flush=True)
    return None


def path(one: Instance) -> object:
    """How much longer sys.path is after twenty more instances."""
    before = len(sys.path)
    for _ in range(20):
        one.slave.fmi2FreeInstance(one.slave.component)
        one.slave.instantiate(callbacks=one.slave.callbacks, loggingOn=True)
    return len(sys.path) - before, one.directory in " ".join(sys.path)


def bounds(one: Instance) -> object:
    """Each parameter at each bound that the description gives, the others as they start: what was refused."""
    given = [
        (variable.name, float(bound))
        for variable in one.description.modelVariables
        if variable.causality == "parameter"
        for bound in (variable.min, variable.max)
        if bound is not None
    ]
    places = {name: value for name, value in given if name.startswith("stabilizer_position")}  # they must increase
    refused = {}
    for name, value in given:
        one.log.clear()
        values = {**places, "rss_position": 0.0} if name in places else {name: value}
        attempt(start, one, values)
        if one.log:
            refused[name] = one.log[0][2]
    return [[name for name, _ in given], refused]


def without_ctypes(fmu: str) -> object:
    """Whether instances in an interpreter without ctypes give the same, and what is logged of a bad step."""
    sys.modules["ctypes"] = None  # type: ignore[assignment]
    with instance(fmu) as one:
        rows = []
        for _ in range(50):
            one.slave.fmi2FreeInstance(one.slave.component)
            one.slave.instantiate(callbacks=one.slave.callbacks, loggingOn=True)
            rows.append(one.initialize().steps(1, 0.7))
        return [rows == rows[:1] * 50, answer(one, one.slave.doStep, 0.0, 1.0)]


def fine_print(fmu: str) -> object:
    """The answers of all that is above, by name."""
    scenarios = (wrong_order, fixed_parameter, stop_time, points, tolerance, signs, user, path, bounds, silent)
    with instance(fmu) as one:
        return {scenario.__name__: scenario(one) for scenario in scenarios}


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))
