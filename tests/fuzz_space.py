"""Random drilling systems in space: none may fail numerically, and contacts and tilt must keep to their discs.

    python tests/fuzz_space.py [--cases N] [--minutes M] [--seed S]

Systems and tolerances are those of the near-bit and of the wide space of fuzz_engines.py; azimuths, walk angles, and
toolfaces against gravity, north or the frame come to them. Few runs are long, so that there are many. Of some cases
it is looked at what must not matter: where the bit stops, whether the run is saved and another one goes on, where
north is, and which side is right. A bit that turns over is no failure. Neither are many steps where the hole is rough;
that a tighter tolerance needs fewer is one. What goes wrong is told with the number of its case, which
`drill(draw(seed, number))` drills again, and ends in exit status 1.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import count
from math import cos, isfinite, pi, radians, sin
from random import Random
from time import monotonic

import numpy as np

from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue
from boreprop.core.options import Options
from boreprop.core.quantities import TOOLFACE_REFERENCES
from boreprop.core.survey import Survey
from boreprop.kernel.space import SpaceDrilling
from fuzz_engines import EXPLAINED, any_tolerance, near_bit, wide
from space_runs import Outputs, Vector, direction, pair, place

LENGTH = 300.0  # m, at most, …
SHORT = 3.0  # … and in all but a few cases so many times the distance from the bit to the last stabilizer
FEW = 0.01
ROWS = 3  # looked at on each leg
STEPS = 500  # for each ℓ₁ of a case, at most, …
TIGHTER = 1e-2  # … unless so much less of the tolerance needs that many, too
SYMMETRIC = 20  # every so many-th case is looked at for what must not matter
HAIR, GROWS = 1e-12, 1e4  # relative; how much more than this a rounding may grow
SAME = 100.0  # tolerances
TURN = 2.0  # of the whole world, rad
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
    toolfaces = tuple(
        random.choice([0.0, pi, random.uniform(-pi, pi), random.uniform(-pi, pi)]) for _ in case.schedule.drilled_length
    )
    reference, tolerance = random.choice(TOOLFACE_REFERENCES), any_tolerance(random)
    longest = LENGTH if random.random() < FEW else SHORT * case.bha.stabilizer_positions[-1]
    case = replace(
        case,
        survey=Survey(case.survey.measured_depth, tuple(inclination)),
        bit=replace(case.bit, walk_angle=walk),
        length=min(case.length, longest),
    )
    return SpaceCase(case, tuple(azimuth), toolfaces, reference, tolerance)


def begin(given: SpaceCase) -> SpaceDrilling:
    """The run of a case before its first step."""
    case = given.case
    steps = STEPS * (1 + case.length / case.length_scale)
    return SpaceDrilling(
        case.bha,
        case.bit,
        case.survey,
        given.azimuth,
        active_weight_on_bit=case.active_weight_on_bit,
        rss_force=case.schedule.rss_force[0],
        rss_toolface=given.toolfaces[0],
        toolface_reference=given.reference,
        options=Options(relative_tolerance=given.tolerance, most_steps=int(steps)),
    )


def drill(given: SpaceCase, stops: int = 1, saves: bool = False) -> Iterator[Outputs]:
    """The outputs along a case; its bit stops so many times from row to row, and another run may go on at each row."""
    case, schedule, run = given.case, given.case.schedule, begin(given)
    ends = [min(end, case.length) for end in (*schedule.drilled_length[1:], case.length)]
    for start, end, force, toolface in zip(
        schedule.drilled_length, ends, schedule.rss_force, given.toolfaces, strict=True
    ):
        if end <= start:
            return
        lengths = np.linspace(start, end, ROWS + 1)
        for row, length in enumerate(lengths[1:]):
            for stop in [*np.linspace(lengths[row], length, stops + 1)[1:-1], length]:
                aim = {"rss_toolface": toolface, "toolface_reference": given.reference}
                run.advance(float(stop), force, case.active_weight_on_bit, **aim)  # type: ignore[arg-type]
            if saves:
                state, run = run.save(), begin(given)
                run.restore(state)
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


def way(given: SpaceCase, **how: int) -> Vector:
    """Where the bit is and where it points along a case, row by row; ℓ₁ and no unit."""
    rows: list[Outputs] = []
    try:
        rows.extend(drill(given, **how))  # type: ignore[arg-type]
    except CannotContinue as stop:
        if stop.code not in EXPLAINED:
            raise
    return np.array([[*place(row) / given.case.length_scale, *direction(row, "bit")] for row in rows]).reshape(-1, 6)


def is_rough(given: SpaceCase) -> bool:
    """Whether a case takes too many steps with a tighter tolerance, too."""
    try:
        for _ in drill(replace(given, tolerance=TIGHTER * given.tolerance)):
            pass
    except CannotContinue as stop:
        return stop.code == "too many"
    return False


def what_matters(given: SpaceCase) -> str | None:
    """What ought not to matter to a case and does, if anything."""
    case, plain = given.case, way(given)
    if not np.array_equal(plain, way(given, stops=3)):
        return "where the bit stops matters"
    if not np.array_equal(plain, way(given, saves=True)):
        return "a saved run goes on to elsewhere"
    others = {"right and left": mirrored(given), "a hair": replace(given, case=stiffer(case))}
    if given.reference != "north":
        others["north"] = replace(given, azimuth=tuple(angle + TURN for angle in given.azimuth))
    back = {"right and left": np.diag([1.0, -1.0, 1.0]), "north": turn(-TURN), "a hair": np.eye(3)}
    apart = {}
    for name, other in others.items():
        there = way(other)
        rows = min(len(plain), len(there))
        there = np.hstack([there[:rows, :3] @ back[name].T, there[:rows, 3:] @ back[name].T])
        apart[name] = np.abs(there - plain[:rows]).max(axis=1, initial=0.0)
    allowed = SAME * given.tolerance + GROWS * np.maximum.accumulate(apart.pop("a hair"))
    for name, off in apart.items():
        rows = min(len(off), len(allowed))
        if (off[:rows] > allowed[:rows]).any():
            return f"{name} matters: {off[:rows].max():g}, a hair {allowed[:rows].max() / GROWS:g}"
    return None


def mirrored(given: SpaceCase) -> SpaceCase:
    """A case with east and west exchanged."""
    bit = replace(given.case.bit, walk_angle=-given.case.bit.walk_angle)
    azimuth, toolfaces = (tuple(-angle for angle in angles) for angles in (given.azimuth, given.toolfaces))
    return replace(given, case=replace(given.case, bit=bit), azimuth=azimuth, toolfaces=toolfaces)


def stiffer(case: Case) -> Case:
    """A case with a BHA that is stiffer by a hair."""
    return replace(case, bha=replace(case.bha, flexural_stiffness=case.bha.flexural_stiffness * (1 + HAIR)))


def turn(angle: float) -> Vector:
    """The matrix of a turn about the vertical, from north to east."""
    return np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])


def examine(seed: int, number: int) -> tuple[int, str, str | None]:
    """What becomes of a case: its number, how it ends, and what is wrong."""
    given, end = draw(seed, number), "drilled"
    try:
        for row in drill(given):
            if fault := fault_of(row, given.case):
                return number, "wrong", fault
    except CannotContinue as stop:
        end = "rough" if stop.code == "too many" and is_rough(given) else stop.code
        if end not in (*EXPLAINED, "rough"):
            return number, end, str(stop)
    except Exception as error:  # whatever it is, it is what is looked for
        return number, type(error).__name__, str(error)
    fault = what_matters(given) if number % SYMMETRIC == 0 and end != "rough" else None
    return number, "asymmetric" if fault else end, fault


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
