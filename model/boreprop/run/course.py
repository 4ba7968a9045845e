"""The course of the inputs of a case over the drilled length: where they change, and how they go on in between.

`simulate` and the drivers of FMUs have it from here, so that both drill the same hole.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Floats
from ..case.case import Case
from ..case.inputs import Profile
from ..core.quantities import ACTING

Indices = NDArray[np.intc]


@dataclass(frozen=True, eq=False)
class Course:
    """Inputs on pieces of the drilled length, on each of which every one is constant or linear.

    Parameters
    ----------
    names
        The inputs.
    starts
        Drilled length at which each piece starts, m, increasing from 0, shape (pieces,).
    values
        The inputs at the start of each piece, in SI units, shape (pieces, inputs).
    slopes
        Their changes per metre drilled, shape (pieces, inputs).
    """

    names: tuple[str, ...]
    starts: Floats
    values: Floats
    slopes: Floats

    @classmethod
    def of(cls, profiles: dict[str, Profile]) -> "Course":
        """The course of some inputs, each with its own entries."""
        starts = np.array(sorted({at for profile in profiles.values() for at in profile.drilled_length}))
        values = np.full((len(starts), len(profiles)), [profile.values[0] for profile in profiles.values()])
        slopes = np.zeros(values.shape)
        for i, profile in enumerate(profiles.values()):
            if len(profile.values) == 1:
                continue
            entry = np.searchsorted(profile.drilled_length, starts, side="right") - 1
            length, value = np.array(profile.drilled_length), np.array(profile.values)
            slope = np.zeros(len(value))
            if profile.linear:
                slope[:-1] = np.diff(value) / np.diff(length)
            values[:, i] = value[entry] + slope[entry] * (starts - length[entry])
            slopes[:, i] = slope[entry]
        return cls(tuple(profiles), starts, values, slopes)

    def changes(self, name: str) -> bool:
        """Whether an input is not the same on all pieces."""
        values = self.values[:, self.names.index(name)]
        return bool((values != values[0]).any())

    def column(self, name: str, length: Floats, piece: Indices) -> Floats:
        """An input at drilled lengths, m, each on the piece of that number; shape (lengths,)."""
        i = self.names.index(name)
        values: Floats = self.values[piece, i]
        if self.slopes[:, i].any():
            values += self.slopes[piece, i] * (length - self.starts[piece])
        return values


def course_of(case: Case) -> Course:
    """The course of all inputs that a case gives."""
    return Course.of(case.profiles())


def acting(course: Course, length: Floats, piece: Indices) -> tuple[Floats, Indices]:
    """What an engine is given for legs that start at some lengths, each on a piece.

    Returns the inputs, (…, inputs) as of `ACTING`, and which of them are those of each leg, (legs,): those of its piece
    as long as nothing is linear.
    """
    on_pieces = np.zeros((len(course.starts), len(ACTING)))
    given = [i for i, name in enumerate(course.names) if name in ACTING]
    on_pieces[:, [ACTING.index(course.names[i]) for i in given]] = course.values[:, given]
    if not course.slopes.any():
        return on_pieces, piece
    for name, slopes in zip(course.names, course.slopes.T, strict=True):
        if f"{name}_slope" in ACTING:
            on_pieces[:, ACTING.index(f"{name}_slope")] = slopes
    inputs: Floats = np.take(on_pieces, piece, axis=0)
    for name, slopes in zip(course.names, course.slopes.T, strict=True):
        if name in ACTING and slopes.any():
            inputs[:, ACTING.index(name)] = course.column(name, length, piece)
    return inputs, np.arange(len(piece), dtype=np.intc)
