"""A case drilled leg by leg, for the fuzzers: along all that changes on its way, by one run or by several."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise, zip_longest

import numpy as np

from boreprop.arrays import Floats
from boreprop.case.case import Case
from boreprop.core.errors import CannotContinue
from boreprop.core.options import Options
from boreprop.core.quantities import CLEARANCES, fields_of, values_of
from boreprop.core.system import BitRock
from boreprop.run.course import Course, acting, course_of
from boreprop.run.engines import Engine, start, start_in_space
from boreprop.run.trajectory import Stopped

ROWS = 3  # looked at on each leg
STEPS = 500  # for each ℓ₁ of a case, at most


def begin(case: Case, options: Options) -> Engine:
    """A case before its first step, natively; what is in the way of that is raised as it is farther on."""
    try:
        return start_in_space(case, options) if case.dimensions == 3 else start(case, "native", options, case.ground)
    except Stopped as stopped:
        raise (stopped.__cause__ or stopped) from None


def drill(
    case: Case, tolerance: float, stops: int = 1, saves: bool = False, steps: int = STEPS
) -> Iterator[tuple[Engine, Case]]:
    """A run row by row along a case, and the case as it is there; the bit stops so many times from row to row.

    From each row another run may go on.
    """
    most = int(steps * (1 + case.length / case.length_scale))
    course, options = course_of(case), Options(relative_tolerance=tolerance, most_steps=most)
    run = begin(case, options)
    for piece, (from_here, end) in enumerate(pairwise([*course.starts, np.inf])):
        if from_here >= case.length:
            return
        here = as_on(case, course, from_here, piece)
        run.change_clearances(here.bha.stabilizer_clearances)
        lengths = np.linspace(from_here, min(end, case.length), ROWS + 1)
        for row_start, row_end in pairwise(lengths):
            for before, length in pairwise([*np.linspace(row_start, row_end, stops + 1)[:-1], row_end]):
                inputs, which = acting(course, np.array([before]), np.array([piece], dtype=np.intc))
                no_row, no_table = np.array([-1], dtype=np.intc), np.empty((0, len(run.outputs())))
                run.follow(np.array([length]), inputs, no_row, no_table, which)
            if saves:
                state, run = run.save(), begin(case, options)
                run.restore(state)
            yield run, as_on(case, course, row_end, piece, int(run.outputs().get("formation", 0)))


def as_on(case: Case, course: Course, length: float, piece: int, layer: int = 0) -> Case:
    """A case with bit and clearances as they are at a drilled length on a piece of its course, in a layer."""
    where = np.array([length]), np.array([piece], dtype=np.intc)
    given = {name: course.column(name, *where).item() for name in course.names}
    clearances = zip(CLEARANCES, case.bha.stabilizer_clearances, strict=False)
    bha = replace(case.bha, stabilizer_clearances=tuple(given.get(name, own) for name, own in clearances))
    bit = BitRock(**fields_of("bit", values_of("bit", case.bit) | given, case.structure))
    bit = case.ground.bit_in(layer, bit) if case.ground else bit
    return replace(case, bha=bha, bit=bit, inputs=None, formations=(), wear=None)


def goes_on_as_it_was(case: Case, tolerance: float) -> bool:
    """Whether runs that go on from each other's saved states go as a single one does, to the last bit."""
    one, others = (states(case, tolerance, saves) for saves in (False, True))
    return all(np.array_equal(state, other) for state, other in zip_longest(one, others))


def states(case: Case, tolerance: float, saves: bool) -> Iterator[Floats | str]:
    """What a run saves at each row, and why it ends before the last one, if it does."""
    try:
        yield from (run.save() for run, _ in drill(case, tolerance, saves=saves))
    except CannotContinue as stop:
        yield str(stop)
