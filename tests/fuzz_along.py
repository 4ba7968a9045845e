"""What may change along the way of a random case, for fuzz_engines.py and fuzz_space.py, and its sensors."""

from dataclasses import replace
from random import Random

from boreprop.case.case import Case
from boreprop.case.formations import Formation
from boreprop.case.inputs import InputSchedule, Schedule
from boreprop.core.ground import Wear
from boreprop.core.quantities import CLEARANCES, ROCK, TOOLFACE_REFERENCES, values_of

MOST = 2.0  # times what a case has: what is drawn for its rock and its clearances, and the inverse of the least
WORN = 0.15  # of the weight, at most, that wear flats bear: less than what a schedule leaves of it


def varied(random: Random, case: Case) -> Case:
    """The case, and by chance each of ramps or jumps of what acts, formations by either depth, wear, and sensors."""
    if random.random() < 0.5:
        case = replace(case, schedule=with_more_forces(random, case))
    scheduled = {name for name in (*ROCK, *CLEARANCES[: len(case.bha.stabilizer_clearances)]) if random.random() < 0.25}
    if random.random() < 0.5:
        case = replace(case, inputs=inputs_of(random, case, scheduled))
    else:
        case = replace(case, formations=formations_of(random, case))
    if random.random() < 0.3:
        largest = random.uniform(0.1, 1.0) * WORN * case.active_weight_on_bit
        case = replace(case, wear=Wear(largest / (random.uniform(0.1, 2.0) * case.length), largest))
    return with_sensors(random, case) if random.random() < 0.3 else case


def share(random: Random) -> float:
    """Of what a case has, up or down."""
    return float(MOST ** random.uniform(-1.0, 1.0))


def entries_of(random: Random, length: float) -> tuple[float, ...]:
    """Drilled lengths at which something changes."""
    return (0.0, *sorted(random.uniform(0.0, length) for _ in range(random.randint(1, 4))))


def with_more_forces(random: Random, case: Case) -> Schedule:
    """Forces of the size that the case has, linear in between."""
    largest = max(map(abs, case.schedule.rss_force)) or 0.1 * case.active_weight_on_bit
    entries = entries_of(random, case.length)
    forces = tuple(random.choice([0.0, random.uniform(-largest, largest)]) for _ in entries)
    if not case.schedule.steers_in_space:
        return Schedule(entries, forces, "linear")
    sides = tuple(random.choice(case.schedule.rss_toolface) for _ in entries)
    return Schedule(entries, forces, "linear", sides, tuple(random.choice(TOOLFACE_REFERENCES) for _ in entries))


def inputs_of(random: Random, case: Case, names: set[str]) -> InputSchedule:
    """The weight, and the inputs and clearances of these names, around what the case has."""
    own = values_of("bit", case.bit) | dict(zip(CLEARANCES, case.bha.stabilizer_clearances, strict=False))
    entries = entries_of(random, case.length)
    given = {name: tuple(own[name] * share(random) for _ in entries) for name in sorted(names)}
    given["active_weight_on_bit"] = tuple(case.active_weight_on_bit * random.uniform(0.2, 1.0) for _ in entries)
    if case.weight_on_bit:
        given["weight_on_bit"] = tuple(case.weight_on_bit * random.uniform(0.9, 1.0) for _ in entries)
        whole = given["weight_on_bit"]  # constant from entry to entry: no ramp of the active one may end above it
        weights = zip(whole, (whole[0], *whole[:-1]), given["active_weight_on_bit"], strict=True)
        given["active_weight_on_bit"] = tuple(min(weights_) for weights_ in weights)
    if case.bit.walk_angle:
        given["bit_walk_angle"] = tuple(case.bit.walk_angle * random.uniform(-1.0, 1.0) for _ in entries)
    return InputSchedule(entries, tuple(given.items()), random.choice(["held", "linear"]))


def formations_of(random: Random, case: Case) -> tuple[Formation, ...]:
    """Up to four, about as far apart as the case is long, by measured or by true vertical depth."""
    by_depth, bit = random.random() < 0.4, case.survey.measured_depth[-1]
    reach = case.length * random.choice([0.05, 1.0])  # a nearly horizontal hole meets thin ones
    tops = sorted(random.uniform(-reach, reach) for _ in range(random.randint(1, 4)))
    found = []
    for top in tops:
        rock = [value * share(random) if random.random() < 0.6 else None for value in bit_of(case)]
        rock[0] = rock[0] or case.bit.lateral_steering_resistance * share(random)
        depths = (bit + top, None) if by_depth else (None, top)
        found.append(Formation(depths[0], rock[0], rock[1], rock[2], depths[1]))
    return tuple(found)


def bit_of(case: Case) -> tuple[float, float, float]:
    """η, χ and ψ* of a case."""
    bit = case.bit
    return bit.lateral_steering_resistance, bit.angular_steering_resistance, bit.tilt_limit


def with_sensors(random: Random, case: Case) -> Case:
    """The case with up to three sensors."""
    count, reach = random.randint(1, 3), case.bha.stabilizer_positions[-1]
    intervals = [random.choice([0.0, random.uniform(0.01, 0.3) * case.length]) for _ in range(count)]
    bha = replace(
        case.bha,
        sensor_positions=tuple(random.uniform(0.0, reach) for _ in intervals),
        sensor_intervals=tuple(intervals),
        sensor_biases=tuple(random.uniform(-1e-3, 1e-3) for _ in intervals),
        sensor_noises=tuple(1e-3 if interval else 0.0 for interval in intervals),
        sensor_seeds=tuple(random.randint(0, 100) for _ in intervals),
        sensor_body_clearances=(),
    )
    return replace(case, bha=bha)
