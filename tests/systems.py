"""Random drilling systems for property tests, and what drills them."""

from itertools import accumulate
from typing import Any

from hypothesis import strategies as st

from boreprop.core.integrator import Integrator
from boreprop.core.modes import Loads, Modes
from boreprop.core.options import RELATIVE_TOLERANCE, Options
from boreprop.core.survey import Survey
from boreprop.core.system import Scaled


def begin(
    scaled: Scaled,
    survey: Survey,
    F_rss: float,
    eta_pi: float,
    relative_tolerance: float = RELATIVE_TOLERANCE,
    **options: Any,
) -> Integrator:
    """The model at the end of a survey in units of ℓ₁."""
    return Integrator(Modes(scaled), survey, 1.0, F_rss, eta_pi, Options(relative_tolerance, **options))


spans = st.floats(0.3, 1.5)


@st.composite
def scaled_systems(draw: st.DrawFn, min_n: int = 1) -> Scaled:
    """Any number of stabilizers, with and without clearance."""
    n = draw(st.integers(min_n, 6))
    s = tuple(accumulate([1.0, *(draw(spans) for _ in range(n - 1))]))
    clearances = st.one_of(st.just(0.0), st.floats(1e-5, 5e-3))
    return Scaled(
        s=s,
        y_star=tuple(draw(clearances) for _ in range(n - 1)),
        Delta=draw(st.floats(0.0, 1.0)),
        w=draw(st.floats(0.0, 1e-2)),
        epsilon=draw(st.floats(0.01, 0.2)),
        psi_star=draw(st.floats(1e-3, 0.05)),
    )


@st.composite
def loads(draw: st.DrawFn, n: int) -> Loads:
    """Offsets, RSS force and weight large enough to close any of the clearances above."""
    offsets = [draw(st.floats(-0.02, 0.02)) for _ in range(n)]
    return Loads(offsets, draw(st.floats(-0.01, 0.01)), draw(st.floats(-1.0, 1.0)))
