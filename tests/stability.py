"""Drilling systems whose stability is tested in several files."""

from dataclasses import replace
from math import pi, radians

from hypothesis import strategies as st

from boreprop.case.case import Case
from boreprop.case.paper import paper_case
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly

PAPER = paper_case()


def drilling(bha: BottomHoleAssembly, bit: BitRock) -> Case:
    """A drilling system in a vertical hole."""
    return replace(PAPER, bha=bha, bit=bit, survey=Survey((0.0, 1.0), (0.0, 0.0)))


VERTICAL = drilling(PAPER.bha, PAPER.bit)
contacts = st.lists(st.integers(0, 1), min_size=5, max_size=5)
inclinations = st.one_of(st.sampled_from([0.0, pi / 2, pi]), st.floats(0.0, 3.0))
LONG = BottomHoleAssembly((0.6193, 6.6906, 10.0877, 18.8639), (1e-3,) * 3, 0.3, 1500.0, 1e7)
BIT = BitRock(20.0, 1.0, radians(1.0))
