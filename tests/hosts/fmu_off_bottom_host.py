"""Off bottom, with weight and rate of penetration 0: scenarios for fmu_host.py's kind of host."""

import json
import sys
from contextlib import suppress
from math import isnan, nan

from fmpy.fmi1 import FMICallException

from fmu_host import Instance, instance

DRILLING = {"rss_force": 8e3, "active_weight_on_bit": 2e3, "rate_of_penetration": 0.01}
OFF_BOTTOM = {"active_weight_on_bit": 0.0, "rate_of_penetration": 0.0}


def drill(one: Instance) -> list[dict[str, float]]:
    one.set_names(dict(DRILLING))
    return one.steps(40, 10.0)


def connect(one: Instance, pads: float) -> list[dict[str, float]]:
    """Three minutes off bottom, with this force of the pads."""
    one.set_names({**OFF_BOTTOM, "rss_force": pads})
    return [one.row(), *one.steps(18, 10.0)]


def life(fmu: str, *pads: str) -> object:
    """Drilling, connections with these forces of the pads, drilling: the rows of each."""
    with instance(fmu) as one:
        one.initialize()
        return [drill(one), *(connect(one, float(force)) for force in pads), drill(one)]


def zeros_first(fmu: str, zeros: str) -> object:
    """Drilling, after a host has sent zeros, or has not, during initialization and for a minute."""
    with instance(fmu) as one:
        one.initialize(**({**OFF_BOTTOM, "rss_force": 0.0} if json.loads(zeros) else {}))
        before = one.steps(6, 10.0) if json.loads(zeros) else []
        return [before, drill(one)]


def progress_without_weight(fmu: str) -> object:
    """Status and log of a step with a rate of penetration but no weight, and what has become of the run."""
    with instance(fmu) as one:
        one.initialize()
        drill(one)
        one.set(active_weight_on_bit=0.0)
        status, log = one.step(10.0), list(one.log)
        return [status, log[-1], drill(one)[0]]


def bad_pads(fmu: str) -> object:
    """Status of a step off bottom with pads at no number, what the outputs show then, and a good step after it."""
    with instance(fmu) as one:
        one.initialize()
        drill(one)
        one.set_names({**OFF_BOTTOM, "rss_force": nan})
        status, shown = one.step(10.0), nan
        with suppress(FMICallException):
            shown = float(one.get("drilled_length"))
        return [status, None if isnan(shown) else shown, drill(one)[0]]


def through_a_state(fmu: str) -> object:
    """A connection, left for another instance by a saved state: the rows after it, there and here."""
    with instance(fmu) as one, instance(fmu) as other:
        one.initialize()
        drill(one)
        connect(one, 0.0)
        other.set_state(one.state())
        other.time = one.time
        return [[other.row(), *drill(other)], [one.row(), *drill(one)]]


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))
