"""Cases whose tipping is tested in several files."""

from boreprop.analysis.rippling import Rippling
from boreprop.analysis.search import State
from boreprop.analysis.study.design import vary
from boreprop.case.case import Case
from boreprop.case.paper import paper_case

YES, NO = Rippling(State.LASTING, 5.0, 0.1), Rippling()


def at(eta_pi: float, **options: float) -> Case:
    return vary(paper_case(**options), {"eta_pi": eta_pi})
