"""Random drilling systems in space: none may fail numerically, and contacts and tilt must keep to their discs.

    python tests/fuzz_space.py [--cases N] [--minutes M] [--seed S]

Systems and tolerances are those of fuzz_engines.py, most of the near-bit and of the wide space, some as built;
azimuths, walk angles, and toolfaces against gravity, north or the frame come to them, and to half of them what
fuzz_along.py lets change along the way. Few runs are long, so that there are many. Of some cases it is looked at what
must not matter: where the bit stops, whether the run is saved and another one goes on, where north is, and which side
is right. A bit that turns over is no failure. Neither are many steps where the hole is rough; that a tighter tolerance
needs less than half of them is one. What goes wrong is told with the number of its case, which
`drill(*draw(seed, number))` drills again, and ends in exit status 1.
"""

import argparse
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import count
from math import cos, isfinite, pi, radians, sin
from random import Random
from time import monotonic

import numpy as np

from boreprop.case.case import Case
from boreprop.case.inputs import Schedule
from boreprop.core.errors import CannotContinue, ParameterError
from boreprop.core.options import Options
from boreprop.core.quantities import TOOLFACE_REFERENCES
from boreprop.core.survey import Survey
from boreprop.run.course import course_of
from boreprop.run.engines import start_in_space
from fuzz_along import varied
from fuzz_engines import EXPLAINED, any_tolerance, as_built, near_bit, wide
from fuzz_legs import STEPS, drill, goes_on_as_it_was
from space_runs import Outputs, Vector, direction, pair, place

LENGTH = 300.0  # m, at most, …
SHORT = 3.0  # … and in all but a few cases so many times the distance from the bit to the last stabilizer
FEW = 0.01
BUILT = 0.15  # of the length of a BHA as built
TIGHTER = 1e-2  # a case is rough if with so much less of the tolerance it takes many steps, too
SYMMETRIC = 20  # every so many-th case is looked at for what must not matter
HAIR, GROWS = 1e-12, 1e4  # relative; how much more than this a rounding may grow
SAME = 100.0  # tolerances
TURN = 2.0  # of the whole world, rad
ROUNDING = 1e-9  # of the largest number in a condition of the discs
SETTLED = 1e-13  # of the largest clearance: so near to their solution contacts are found, in kernel/cone.h
BATCH = 20  # cases that a process gets at once


def draw(seed: int, number: int) -> tuple[Case, float]:
    """A case by its number, and its tolerance: now and then as built; in one of two, more changes along the way."""
    along = Random(f"space {seed} {number} along")
    case, tolerance = plain(seed, number) if along.random() < 0.85 else built_in_space(along)
    case = varied(along, case) if along.random() < 0.5 else case
    if case.bha.body_point_positions:  # a body on the wall takes many steps
        case = replace(case, length=BUILT * case.length)
    return case, tolerance


def plain(seed: int, number: int) -> tuple[Case, float]:
    """A case by its number whose beam is the paper's, under forces that are held, and its tolerance."""
    random = Random(f"space {seed} {number}")
    return in_space(random, (wide if random.random() < 0.6 else near_bit)(random)[0])


def built_in_space(random: Random) -> tuple[Case, float]:
    """A case as built, under a weight that it bears in space, where a stabilizer on the wall holds to no side."""
    case, tolerance = in_space(random, as_built(random)[0])
    if case.bha.axial_load:
        try:
            start_in_space(replace(case, weight_on_bit=1e15), Options())
        except ParameterError as error:
            weight = random.uniform(0.3, 0.99) * (error.problem.limit if error.problem else 0.0)
        if weight > 0.0:
            return replace(
                case, active_weight_on_bit=random.uniform(0.2, 1.0) * weight, weight_on_bit=weight
            ), tolerance
        case = replace(case, bha=replace(case.bha, axial_load=False))
    return case, tolerance


def in_space(random: Random, case: Case) -> tuple[Case, float]:
    """A case in the plane with what it has in space besides, and a tolerance."""
    stations = len(case.survey.measured_depth)
    azimuth = [random.uniform(-pi, pi)]
    for _ in range(stations - 1):
        azimuth.append(azimuth[-1] + random.choice([0.0, radians(random.uniform(-5.0, 5.0))]))
    inclination = [angle if random.random() < 0.2 else abs(angle) for angle in case.survey.inclination]
    kind = 1.0 if case.bha.axial_load else random.random()  # what a BHA bears depends on the inclination
    if kind < 0.3:  # nearly vertical, or from there to the vertical
        inclination = [0.0] * (stations - 1) + [radians(random.uniform(0.0, 2.0))]
        inclination = inclination if kind < 0.2 else inclination[::-1]
    walk = random.choice([0.0, radians(random.uniform(-30.0, 30.0)), radians(random.uniform(-85.0, 85.0))])
    lengths, forces = case.schedule.drilled_length, case.schedule.rss_force
    toolfaces = tuple(random.choice([0.0, pi, random.uniform(-pi, pi), random.uniform(-pi, pi)]) for _ in lengths)
    references, tolerance = (random.choice(TOOLFACE_REFERENCES),) * len(lengths), any_tolerance(random)
    longest = LENGTH if random.random() < FEW else SHORT * case.bha.stabilizer_positions[-1]
    case = replace(
        case,
        survey=Survey(case.survey.measured_depth, tuple(inclination), tuple(azimuth)),
        bit=replace(case.bit, walk_angle=walk),
        length=min(case.length, longest),
        schedule=Schedule(lengths, forces, "held", toolfaces, references),
        dimensions=3,
    )
    return case, tolerance


def fault_of(row: Outputs, case: Case) -> str | None:
    """What is wrong with outputs, if anything."""
    if not all(map(isfinite, row.values())):
        return f"not finite: {', '.join(name for name, value in row.items() if not isfinite(value))}"
    forces = [pair(row, "stabilizer_force", i) for i in range(1, len(case.bha.stabilizer_clearances) + 1)]
    largest = max((float(np.hypot(*force)) for force in forces), default=0.0)
    settled = SETTLED * max((*case.bha.stabilizer_clearances, *case.bha.body_point_clearances), default=0.0)
    for i, (force, clearance) in enumerate(zip(forces, case.bha.stabilizer_clearances, strict=True), 1):
        delta, size = pair(row, "stabilizer_deflection", i), float(np.hypot(*force))
        room = settled + ROUNDING * (clearance + largest * case.bha.stabilizer_positions[-1] / case.bha.force_scale)
        if np.hypot(*delta) > clearance + room:
            return f"stabilizer {i} is {np.hypot(*delta) - clearance:g} m beyond the wall"
        if abs(force @ delta + clearance * size) > room * (size + ROUNDING * largest):
            return f"the wall does not push stabilizer {i} straight inwards: {force}, {delta}"
    if row["bit_tilt"] > case.bit.tilt_limit * (1 + ROUNDING):
        return "the tilt is beyond its limit"
    return None


def way(case: Case, tolerance: float, stops: int = 1) -> Vector:
    """Where the bit is and where it points along a case, row by row; ℓ₁ and no unit."""
    rows: list[Outputs] = []
    try:
        rows.extend(run.outputs() for run, _ in drill(case, tolerance, stops))
    except CannotContinue as stop:
        if stop.code not in EXPLAINED:
            raise
    return np.array([[*place(row) / case.length_scale, *direction(row, "bit")] for row in rows]).reshape(-1, 6)


def is_rough(case: Case, tolerance: float) -> bool:
    """Whether a case takes more than half of too many steps with a tighter tolerance, too."""
    try:
        for _ in drill(case, TIGHTER * tolerance, steps=STEPS // 2):
            pass
    except CannotContinue as stop:
        return stop.code == "too many"
    return False


def what_matters(case: Case, tolerance: float) -> str | None:
    """What ought not to matter to a case and does, if anything."""
    here, stopping = way(case, tolerance), way(case, tolerance, stops=3)
    even = not (course_of(case).slopes.any() or case.ground)  # on a ramp a stop rounds what acts
    if even and not np.array_equal(here, stopping):
        return "where the bit stops matters"
    if not goes_on_as_it_was(case, tolerance):
        return "a saved run goes on to elsewhere"
    others = {"right and left": way(mirrored(case), tolerance)}
    hairs = {"a hair": way(stiffer(case), tolerance), "a hair across": way(crooked(case), tolerance)}
    others["where the bit stops"] = stopping
    if "north" not in case.schedule.toolface_reference:
        azimuth = tuple(angle + TURN for angle in case.survey.azimuth)
        others["north"] = way(replace(case, survey=replace(case.survey, azimuth=azimuth)), tolerance)
    back = {"right and left": np.diag([1.0, -1.0, 1.0]), "north": turn(-TURN)}
    apart = {}
    for name, there in (others | hairs).items():
        rows, to_here = min(len(here), len(there)), back.get(name, np.eye(3)).T
        there = np.hstack([there[:rows, :3] @ to_here, there[:rows, 3:] @ to_here])
        apart[name] = np.abs(there - here[:rows]).max(axis=1, initial=0.0)
    moved = [apart.pop(name) for name in hairs]
    rows = min(map(len, moved))
    allowed = SAME * tolerance + GROWS * np.maximum.accumulate(np.max([off[:rows] for off in moved], axis=0))
    for name, off in apart.items():
        rows = min(len(off), len(allowed))
        if (off[:rows] > allowed[:rows]).any():
            return f"{name} matters: {off[:rows].max():g}, a hair {allowed[:rows].max() / GROWS:g}"
    return None


def mirrored(case: Case) -> Case:
    """A case with east and west exchanged."""
    azimuth, toolfaces = (
        tuple(-angle for angle in angles) for angles in (case.survey.azimuth, case.schedule.rss_toolface)
    )
    inputs = case.inputs and replace(
        case.inputs,
        inputs=tuple(
            (name, tuple(-value for value in values) if name == "bit_walk_angle" else values)
            for name, values in case.inputs.inputs
        ),
    )
    return replace(
        case,
        bit=replace(case.bit, walk_angle=-case.bit.walk_angle),
        survey=replace(case.survey, azimuth=azimuth),
        schedule=replace(case.schedule, rss_toolface=toolfaces),
        inputs=inputs,
    )


def crooked(case: Case) -> Case:
    """The case with a hair's bend across its hole: what lies in one plane may be about to buckle out of it."""
    *before, last = case.survey.azimuth or (0.0,) * len(case.survey.inclination)
    return replace(case, survey=replace(case.survey, azimuth=(*before, last + HAIR)))


def stiffer(case: Case) -> Case:
    """A case with a BHA that is stiffer by a hair."""
    bha, more = case.bha, 1 + HAIR
    sections = tuple(stiffness * more for stiffness in bha.section_flexural_stiffnesses)
    stiff = replace(bha, flexural_stiffness=bha.flexural_stiffness * more, section_flexural_stiffnesses=sections)
    return replace(case, bha=stiff)


def turn(angle: float) -> Vector:
    """The matrix of a turn about the vertical, from north to east."""
    return np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])


def examine(seed: int, number: int) -> tuple[int, str, str | None]:
    """What becomes of a case: its number, how it ends, and what is wrong."""
    return number, *ending(*draw(seed, number), symmetric=number % SYMMETRIC == 0)


def ending(case: Case, tolerance: float, symmetric: bool = False) -> tuple[str, str | None]:
    """How a case ends, and what is wrong; if it is to be symmetric, also in what ought not to matter."""
    end = "drilled"
    try:
        for run, here in drill(case, tolerance):
            if fault := fault_of(run.outputs(), here):
                return "wrong", fault
    except CannotContinue as stop:
        end = "rough" if stop.code == "too many" and is_rough(case, tolerance) else stop.code
        if end not in (*EXPLAINED, "rough"):
            return end, str(stop)
    except Exception as error:  # whatever it is, it is what is looked for
        return type(error).__name__, str(error)
    fault = what_matters(case, tolerance) if symmetric and end != "rough" else None
    return "asymmetric" if fault else end, fault


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
