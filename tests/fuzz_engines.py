"""Random drilling systems through both engines: none may fail numerically, and both must say the same.

    python tests/fuzz_engines.py SPACE [--cases N] [--minutes M] [--seed S] [--python K] [--processes P]

The near-bit space is that of BHAs with a stabilizer 0.8 to 2 m behind the bit under a low weight, over 300 m, now and
then over 8 km; the wide one is of all that the model takes, over 10 ℓ₁; the as-built one is of BHAs in sections whose
body may lie on the wall, most of them under an axial load up to nearly what they bear, over 60 m. All have force steps
and tolerances between 1e-9 and 1e-5; half of them have besides what fuzz_along.py lets change along the way. The native
engine runs every case, some of them saved and restored on the way, too; Python the first K, and each in which the
native one stops, if the beam is the paper's. A bit that turns over is no failure, nor is a BHA that snaps from wall to
wall or lies on the wall at more points than there is room for. What goes wrong is told with the case file that shows
it, and ends in exit status 1.

Some runs depend on their last digits: small differences grow, and rounding may decide whether a step ends on a kink.
Where the engines differ, both run again with a BHA that is stiffer and longer by a few 1e-12, and may differ by ten
times what that moves either. Where that is much, rows count as not compared.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass, replace
from itertools import accumulate, count, islice
from math import log10, pi, radians
from pathlib import Path
from random import Random
from time import monotonic

import numpy as np

from beams_as_built import bearable
from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.case.file import dump_case
from boreprop.case.inputs import Schedule
from boreprop.core.errors import CannotContinue
from boreprop.core.options import RELATIVE_TOLERANCE
from boreprop.core.survey import Survey
from boreprop.core.system import LEAST_SPAN, BitRock, BottomHoleAssembly
from boreprop.run.simulate import simulate
from boreprop.run.trajectory import Stopped, Trajectory
from fuzz_along import varied
from fuzz_legs import goes_on_as_it_was

COMPARED = 50.0  # m at the start of a run, over which both engines are compared
AGREEMENT, SMALL = 1e-6, 1e-6  # of the largest value of a column, which is at least so large
HAIRS = [sign * k * 1e-12 for k in range(1, 7) for sign in (1, -1)]  # relative
LIKE = 10.0  # times what a hair moves either engine, by which they may differ besides
EXPLAINED = ("turns over", "snaps", "too crowded")  # codes of stops that are no failure
SAVED = 10  # every so many-th case is also drilled by runs that take over from each other
BATCH = 20  # cases that a process gets at once
FOLDER = Path("out/fuzz")


def near_bit(random: Random) -> tuple[Case, float]:
    """A case with a near-bit stabilizer and a low weight, and a tolerance."""
    first = random.uniform(0.8, 2.0)
    positions = tuple(accumulate([first, *(random.uniform(3.5, 9.5) for _ in range(random.randint(1, 3)))]))
    clearances = [random.choice([2e-3, 5e-3, 15e-3, 30e-3]), *(random.uniform(5e-4, 4e-3) for _ in positions[2:])]
    bha = BottomHoleAssembly(positions, tuple(clearances), min(0.6, first / 2), 1500.0, 10 ** random.uniform(6.8, 7.6))
    inclination, end = radians(random.choice([0.0, 10.0, 40.0])), positions[-1]
    case = Case(
        bha=bha,
        bit=BitRock(20.0, 1.0, radians(random.uniform(0.5, 1.5))),
        bit_diameter=0.2,
        active_weight_on_bit=10 ** random.uniform(2.8, 4.5),
        length=8000.0 if random.random() < 0.003 else 300.0,
        survey=Survey((0.0, end, end + 8.0), (inclination, inclination, inclination + radians(1.5))),
    )
    if random.random() < 0.1:
        changes = tuple(accumulate([0.0, *(random.uniform(0.3, 8.0) for _ in range(40))]))
        case = replace(case, schedule=Schedule(changes, tuple(random.uniform(-3e3, 3e3) for _ in changes)))
    return case, any_tolerance(random)


def wide(random: Random) -> tuple[Case, float]:
    """A case from all that the model takes, and a tolerance."""
    l1, n = random.uniform(1.0, 6.0), random.randint(1, 6)
    powers = [(-2.0, 0.5) if random.random() < 0.15 else (log10(0.3), log10(2.5)) for _ in range(n - 1)]
    spans = [max(10 ** random.uniform(*power), 1.001 * LEAST_SPAN / l1) for power in powers]
    clearances = [0.0 if random.random() < 0.15 else 10 ** random.uniform(-9.0, -2.0) for _ in spans]
    bha = BottomHoleAssembly(
        stabilizer_positions=tuple(l1 * s for s in accumulate([1.0, *spans])),
        stabilizer_clearances=tuple(l1 * y for y in clearances),
        rss_position=random.uniform(0.0, l1),
        distributed_weight=10 ** random.uniform(0.0, 4.0),
        flexural_stiffness=10 ** random.uniform(6.0, 8.0),
    )
    eta = 20.0
    first = radians(random.uniform(-170.0, 170.0))
    last, end = first + radians(random.uniform(-5.0, 5.0)), bha.stabilizer_positions[-1]
    changes = [0.0, *sorted(random.uniform(0.0, 10.0 * l1) for _ in range(random.randint(0, 4)))]
    forces = [random.choice([-1.0, 1.0]) * 10 ** random.uniform(-5.0, -1.0) * bha.force_scale for _ in changes]
    case = Case(
        bha=bha,
        bit=BitRock(eta, eta * 10 ** random.uniform(-4.0, 1.0), radians(10 ** random.uniform(-2.0, 1.0))),
        bit_diameter=0.2,
        active_weight_on_bit=10 ** random.uniform(-5.0, 3.0) * bha.force_scale / eta,
        length=10.0 * l1,
        survey=Survey((0.0, end, end + 1.0), (first, first, last)),
        schedule=Schedule(tuple(changes), tuple(forces)) if len(changes) > 1 else Schedule(),
    )
    return case, any_tolerance(random)


def as_built(random: Random) -> tuple[Case, float]:
    """A case with sections, some with an axial load, whose body may lie on the wall, and a tolerance."""
    near = [random.uniform(0.6, 2.0)] if random.random() < 0.4 else []
    spans = [*near, *(random.uniform(2.0, 25.0) for _ in range(random.randint(1, 5 - len(near))))]
    positions = tuple(accumulate(spans))
    reach, hole = positions[-1], random.choice([0.1524, 0.2159, 0.31115, 0.4445])
    count = random.randint(1, 4)
    outer = [random.uniform(0.5, 0.93) * hole for _ in range(count)]
    inner = [random.uniform(0.2, 0.6) * diameter for diameter in outer]
    ends = sorted(random.uniform(0.0, reach) for _ in range(count - 1))
    lengths = [b - a for a, b in zip([0.0, *ends], [*ends, reach * 1.01], strict=True)]
    spacing = max(random.choice([0.3, 0.5, 1.0, 1.5]), reach / 110)
    points = [s for s in np.arange(random.uniform(0.3, 1.5), reach, spacing).tolist() if s not in positions]
    body = [outer[int(np.searchsorted(np.cumsum(lengths), s))] for s in points]
    bha = BottomHoleAssembly(
        positions,
        tuple(random.choice([0.0, random.uniform(2e-4, 1e-2)]) for _ in positions[1:]),
        random.uniform(0.1, 1.0) * min(positions[0], 1.0),
        1.0,
        1.0,
        section_lengths=tuple(lengths),
        section_distributed_weights=tuple(
            9.81 * 6500 * pi / 4 * (D**2 - d**2) for D, d in zip(outer, inner, strict=True)
        ),
        section_flexural_stiffnesses=tuple(206e9 * pi / 64 * (D**4 - d**4) for D, d in zip(outer, inner, strict=True)),
        section_outer_diameters=tuple(outer),
        body_point_positions=tuple(points),
        body_point_clearances=tuple((hole - diameter) / 2 for diameter in body),
        end_deflection=-random.uniform(0.0, 0.03) if random.random() < 0.2 else 0.0,
        axial_load=random.random() < 0.7,
    )
    inclination, turn = radians(random.choice([0.0, random.uniform(0.0, 100.0)])), radians(random.uniform(-3.0, 3.0))
    weight = 10 ** random.uniform(3.5, 5.5)
    if bha.axial_load:  # up to nearly what the BHA bears
        weight = min(weight, random.uniform(0.3, 0.99) * bearable(bha, inclination + turn))
    changes = [0.0, *accumulate(random.uniform(0.3, 15.0) for _ in range(random.choice([0, 0, 8])))]
    case = Case(
        bha=bha,
        bit=BitRock(10 ** random.uniform(0.0, 2.0), 10 ** random.uniform(-1.5, 0.7), radians(random.uniform(0.3, 3.0))),
        bit_diameter=hole,
        active_weight_on_bit=random.uniform(0.2, 1.0) * weight,
        weight_on_bit=weight if bha.axial_load else 0.0,
        length=60.0,
        survey=Survey((0.0, reach, reach + random.uniform(3.0, 30.0)), (inclination, inclination, inclination + turn)),
        schedule=Schedule(tuple(changes), tuple(random.uniform(-3e4, 3e4) for _ in changes)),
    )
    return case, any_tolerance(random)


def any_tolerance(random: Random) -> float:
    """The usual one, or any."""
    return RELATIVE_TOLERANCE if random.random() < 0.5 else 10 ** random.uniform(-9.0, -5.0)


SPACES: dict[str, Callable[[Random], tuple[Case, float]]] = {"near-bit": near_bit, "wide": wide, "as-built": as_built}


@dataclass
class Finding:
    """What became of one case."""

    number: int
    stopped: str | None  # the code of why the native engine stopped
    fault: str | None = None  # what is wrong
    rows: int = 0  # compared with Python
    uncompared: int = 0  # rows beyond the place where a hair decides


def examine(space: str, seed: int, number: int, compared: bool) -> Finding:
    """Run one case natively; compare it with Python if asked, or if it stops."""
    case, tolerance = draw(space, seed, number)
    short = replace(case, length=min(COMPARED, case.length))
    try:
        run, failure = drilled(case, tolerance, "native", case.length / 10)
        found = Finding(number, failure.code if failure else None)
        if failure and failure.code not in EXPLAINED:
            found.fault = str(failure)
        elif not all(np.isfinite(column).all() for column in run.columns.values()):
            found.fault = "a column is not finite"
        if (compared or failure) and case.bha.structure.is_of_the_paper and not found.fault:
            compare(case if failure else short, tolerance, found)
        if number % SAVED == 0 and not found.fault and not goes_on_as_it_was(short, tolerance):
            found.fault = "a saved run goes on to elsewhere"
    except Stopped as error:  # where the run starts
        code = getattr(error.__cause__, "code", None)
        return Finding(number, code, None if code in EXPLAINED else str(error))
    except Exception as error:  # whatever it is, it is what is looked for
        return Finding(number, None, f"{type(error).__name__}: {error}")
    return found


def draw(space: str, seed: int, number: int) -> tuple[Case, float]:
    """A case of a space and its tolerance, by number; in one of two, more changes along the way."""
    case, tolerance = SPACES[space](Random(f"{space} {seed} {number}"))
    along = Random(f"{space} {seed} {number} along")
    return varied(along, case) if along.random() < 0.5 else case, tolerance


def drilled(case: Case, tolerance: float, engine: str, interval: float) -> tuple[Trajectory, CannotContinue | None]:
    """A run, or what there is of it and why it ended."""
    try:
        return simulate(case, sample_interval=interval, relative_tolerance=tolerance, engine=engine), None
    except Stopped as stopped:
        if stopped.trajectory is None or not isinstance(stopped.__cause__, CannotContinue):
            raise
        return stopped.trajectory, stopped.__cause__


def compare(case: Case, tolerance: float, found: Finding) -> None:
    """Drill with both engines, and note where they differ more than they may."""
    interval = min(case.length, COMPARED) / 100
    runs = {engine: drilled(case, tolerance, engine, interval) for engine in ("python", "native")}
    (python, end_of_python), (native, end_of_native) = runs.values()
    off, ends_differ = apart(python, native), not same_end(end_of_python, end_of_native)
    moved = np.zeros(len(off))
    for hair in HAIRS:
        if not (ends_differ or (off > AGREEMENT + LIKE * moved).any()):
            break
        for engine, (run, end) in runs.items():
            other, end_of_other = drilled(moved_by(hair, case), tolerance, engine, interval)
            by = apart(other, run)[: len(off)]
            moved[: len(by)] = np.maximum(moved[: len(by)], by)
            ends_differ &= same_end(end_of_other, end)
        moved = np.maximum.accumulate(moved)
    found.rows = int(np.count_nonzero(moved <= AGREEMENT / LIKE))
    found.uncompared = native.row_count - found.rows
    bad = off > AGREEMENT + LIKE * moved
    if bad.any():
        found.fault = f"the engines differ at {native['drilled_length'][np.argmax(bad)]:g} m"
    elif ends_differ:
        found.fault = f"python: {end_of_python or 'no stop'}; native: {end_of_native or 'no stop'}"


def moved_by(hair: float, case: Case) -> Case:
    """The case with a BHA that is longer and stiffer by a hair."""
    bha, positions = case.bha, case.bha.stabilizer_positions
    longer = tuple(position * (1 + i * hair) for i, position in enumerate(positions))
    stiffer = bha.flexural_stiffness * (1 + hair)
    return replace(case, bha=replace(bha, flexural_stiffness=stiffer, stabilizer_positions=longer))


def apart(one: Trajectory, other: Trajectory) -> Floats:
    """By how much the rows that both have differ, of the largest value of a column, at most."""
    rows = min(one.row_count, other.row_count)
    most = np.zeros(rows)
    for name, column in other.columns.items():
        if name.startswith(("stabilizer_contact", "bit_tilt_saturation", "formation")):
            continue  # whole numbers: a row may lie on the event
        off = np.abs(one[name][:rows] - column[:rows])
        most = np.maximum(most, off / (np.abs(column).max() + SMALL))
    return most


def same_end(one: CannotContinue | None, other: CannotContinue | None) -> bool:
    """Whether both went to the end, or stopped at the same place for the same reason."""
    if one is None or other is None:
        return one is other
    return one.code == other.code and abs(one.place - other.place) <= AGREEMENT * max(one.place, 1.0)


def findings(
    space: str, seed: int, numbers: Iterator[int], python: int, until: float, processes: int
) -> Iterator[Finding]:
    """What becomes of the cases, as it is known, until all are done or the time is over."""
    with ProcessPoolExecutor(processes) as pool:
        running: set[Future[list[Finding]]] = set()
        while True:
            while len(running) < 2 * processes and monotonic() < until and (batch := list(islice(numbers, BATCH))):
                running.add(pool.submit(examine_all, space, seed, batch, python))
            if not running:
                return
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                yield from future.result()


def examine_all(space: str, seed: int, numbers: list[int], python: int) -> list[Finding]:
    """In a process."""
    return [examine(space, seed, number, number < python) for number in numbers]


def report(space: str, seed: int, found: Finding) -> None:
    """Tell what is wrong with a case, and keep its file."""
    case, tolerance = draw(space, seed, found.number)
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{space}-{seed}-{found.number}.toml"
    path.write_text(dump_case(case), encoding="utf-8")
    print(f"{path} --tolerance {tolerance!r}: {found.fault}", flush=True)


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="Random drilling systems through both engines.")
    parser.add_argument("space", choices=SPACES)
    parser.add_argument("--cases", type=int, help="how many; without it, until the minutes are over")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="start no case after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--python", type=int, default=100, help="how many, the first, Python runs too")
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    if given.cases is None and given.minutes == float("inf"):
        parser.error("must be given --cases or --minutes")
    numbers = count() if given.cases is None else iter(range(given.cases))
    totals: Counter[str] = Counter()
    stops: Counter[str] = Counter()
    until = monotonic() + 60 * given.minutes
    for found in findings(given.space, given.seed, numbers, given.python, until, given.processes):
        totals["cases"] += 1
        totals["failures"] += found.fault is not None
        if found.stopped and not found.fault:
            stops[found.stopped] += 1
        totals["compared"] += found.rows > 0
        totals["cut short"] += found.uncompared > 0
        if found.fault:
            report(given.space, given.seed, found)
    print(
        f"{given.space}, seed {given.seed}: {totals['cases']} cases, {totals['failures']} failures; "
        f"stopped: {', '.join(f'{code} {count}' for code, count in stops.most_common()) or 'none'}; "
        f"{totals['compared']} in Python too, "
        f"{totals['cut short']} of them up to where a hair decides"
    )
    return 1 if totals["failures"] else 0


if __name__ == "__main__":
    sys.exit(main())
