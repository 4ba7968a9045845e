"""BHAs that leave their holes, or do not: scenarios for fmu_host.py's kind of host."""

import json
import sys

from fmu_host import Instance, instance


def begin(one: Instance, force: str) -> Instance:
    one.log.clear()
    return one.initialize(rss_force=float(force))


def along(fmu: str, count: str, size: str, force: str) -> object:
    """The log after steps."""
    with instance(fmu) as one:
        begin(one, force).steps(int(count), float(size))
        return one.log


def back_and_forth(fmu: str) -> object:
    """How many lines are logged: by a run, by more of it from a state before each, and by the run after a reset."""
    with instance(fmu) as one:
        start = begin(one, "0").state()
        one.steps(20, 0.5)
        counts = [len(one.log)]
        for _ in range(3):
            one.set_state(start)
            one.time = 0.0
            one.steps(20, 0.5)
        counts.append(len(one.log))
        one.slave.reset()
        begin(one, "0").steps(20, 0.5)
        return [*counts, len(one.log)]


def without_logging(fmu: str) -> object:
    """The log of a host that has not asked for one."""
    with instance(fmu) as one:
        one.slave.fmi2FreeInstance(one.slave.component)
        one.slave.instantiate(callbacks=one.slave.callbacks, loggingOn=False)
        begin(one, "0").steps(3, 0.5)
        return one.log


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:])))
