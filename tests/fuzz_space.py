"""Random drilling systems in space: none may fail numerically, and contacts and tilt must keep to their discs.

    python tests/fuzz_space.py [--cases N] [--minutes M] [--seed S]

Systems and tolerances are those of the near-bit and of the wide space of fuzz_engines.py; azimuths, walk angles, and
toolfaces against gravity, north or the frame come to them. A bit that turns over is no failure. What goes wrong is told
with the number of its case, which `drill(seed, number)` drills again, and ends in exit status 1.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import count
from math import isfinite, pi, radians
from random import Random
from time import monotonic

import numpy as np

from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue
from boreprop.core.options import Options
from boreprop.core.quantities import TOOLFACE_REFERENCES
from boreprop.core.survey import Survey
from boreprop.kernel.space import SpaceDrilling
from fuzz_engines import any_tolerance, near_bit, wide
from space_runs import Outputs, pair

LENGTH = 300.0  # m, at most
ROWS = 3  # looked at on each leg
ROUNDING = 1e-9  # of the largest number in a condition of the discs
BATCH = 20  # cases that a process gets at once


@dataclass(frozen=True)
class SpaceCase:
    """A case with what it has in space besides."""

    case: Case
    azimuth: tuple[float, ...]
    toolfaces: tuple[float, ...]  # one a leg
    reference: str
    tolerance: float


def draw(seed: int, number: int) -> SpaceCase:
    """A case by its number."""
    random = Random(f"space {seed} {number}")
    case, _ = (wide if random.random() < 0.6 else near_bit)(random)
    stations = len(case.survey.measured_depth)
    azimuth = [random.uniform(-pi, pi)]
    for _ in range(stations - 1):
        azimuth.append(azimuth[-1] + random.choice([0.0, radians(random.uniform(-5.0, 5.0))]))
    inclination = [angle if random.random() < 0.2 else abs(angle) for angle in case.survey.inclination]
    kind = random.random()
    if kind < 0.3:  # nearly vertical, or from there to the vertical
        inclination = [0.0] * (stations - 1) + [radians(random.uniform(0.0, 2.0))]
        inclination = inclination if kind < 0.2 else inclination[::-1]
    walk = random.choice([0.0, radians(random.uniform(-30.0, 30.0)), radians(random.uniform(-85.0, 85.0))])
    legs = len(case.schedule.drilled_length)
    return SpaceCase(
        replace(
            case,
            survey=Survey(case.survey.measured_depth, tuple(inclination)),
            bit=replace(case.bit, walk_angle=walk),
            length=min(case.length, LENGTH),
        ),
        tuple(azimuth),
        tuple(random.choice([0.0, pi, random.uniform(-pi, pi), random.uniform(-pi, pi)]) for _ in range(legs)),
        random.choice(TOOLFACE_REFERENCES),
        any_tolerance(random),
    )


def drill(seed: int, number: int) -> Iterator[Outputs]:
    """The outputs along a case."""
    given = draw(seed, number)
    case, schedule = given.case, given.case.schedule
    run = SpaceDrilling(
        case.bha,
        case.bit,
        case.survey,
        given.azimuth,
        active_weight_on_bit=case.active_weight_on_bit,
        rss_force=schedule.rss_force[0],
        rss_toolface=given.toolfaces[0],
        toolface_reference=given.reference,
        options=Options(relative_tolerance=given.tolerance),
    )
    ends = (*schedule.drilled_length[1:], case.length)
    for begin, end, force, toolface in zip(
        schedule.drilled_length, ends, schedule.rss_force, given.toolfaces, strict=True
    ):
        for length in np.linspace(begin, min(end, case.length), ROWS + 1)[1:]:
            if length > begin:
                aim = {"rss_toolface": toolface, "toolface_reference": given.reference}
                run.advance(float(length), force, case.active_weight_on_bit, **aim)  # type: ignore[arg-type]
                yield run.outputs()


def fault_of(row: Outputs, case: Case) -> str | None:
    """What is wrong with outputs, if anything."""
    if not all(map(isfinite, row.values())):
        return f"not finite: {', '.join(name for name, value in row.items() if not isfinite(value))}"
    forces = [pair(row, "stabilizer_force", i) for i in range(1, len(case.bha.stabilizer_clearances) + 1)]
    largest = max((float(np.hypot(*force)) for force in forces), default=0.0)
    for i, (force, clearance) in enumerate(zip(forces, case.bha.stabilizer_clearances, strict=True), 1):
        delta, size = pair(row, "stabilizer_deflection", i), float(np.hypot(*force))
        room = ROUNDING * (clearance + largest * case.bha.stabilizer_positions[-1] / case.bha.force_scale)
        if np.hypot(*delta) > clearance + room:
            return f"stabilizer {i} is {np.hypot(*delta) - clearance:g} m beyond the wall"
        if abs(force @ delta + clearance * size) > room * (size + ROUNDING * largest):
            return f"the wall does not push stabilizer {i} straight inwards: {force}, {delta}"
    if row["bit_tilt"] > case.bit.tilt_limit * (1 + ROUNDING):
        return "the tilt is beyond its limit"
    return None


def examine(seed: int, number: int) -> tuple[int, str, str | None]:
    """What becomes of a case: its number, how it ends, and what is wrong."""
    case = draw(seed, number).case
    try:
        for row in drill(seed, number):
            if fault := fault_of(row, case):
                return number, "wrong", fault
    except CannotContinue as stop:
        return number, stop.code, None if stop.code == "turns over" else str(stop)
    except Exception as error:  # whatever it is, it is what is looked for
        return number, type(error).__name__, str(error)
    return number, "drilled", None


def examine_all(seed: int, numbers: range) -> list[tuple[int, str, str | None]]:
    """In a process."""
    return [examine(seed, number) for number in numbers]


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="Random drilling systems in space.")
    parser.add_argument("--cases", type=int, help="how many; without it, until the minutes are over")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="start no case after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    if given.cases is None and given.minutes == float("inf"):
        parser.error("must be given --cases or --minutes")
    totals: Counter[str] = Counter()
    failures, until = 0, monotonic() + 60 * given.minutes
    with ProcessPoolExecutor(given.processes) as pool:
        for first in count(0, BATCH * given.processes):
            last = first + BATCH * given.processes
            if (given.cases is not None and first >= given.cases) or monotonic() > until:
                break
            starts = range(first, last if given.cases is None else min(last, given.cases), BATCH)
            end = last if given.cases is None else given.cases
            batches = [range(start, min(start + BATCH, end)) for start in starts]
            for found in pool.map(examine_all, [given.seed] * len(batches), batches):
                for number, kind, fault in found:
                    totals[kind] += 1
                    if fault:
                        failures += 1
                        print(f"{given.seed} {number}: {kind}: {fault}", flush=True)
    print(f"seed {given.seed}: {dict(totals)}, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
