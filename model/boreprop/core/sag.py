"""How far the axis of the BHA is from that of the hole, and what is said where it leaves the hole.

Between the bit, the pads and the stabilizers nothing holds the beam of the model. Where its axis comes out of the hole,
the wall would carry it in truth, and neither forces nor build rates are those of the real BHA.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

from .beam import Beam
from .drilling import Drilling
from .linear import dot
from .problems import OUTSIDE

POINTS = 36  # along the BHA: between two, its axis bends by far less than it sags
OFTEN = 1 / 8  # of the length of a BHA, at most, from look to look of an FMU; more rarely, the farther from the wall


@dataclass(frozen=True)
class Sag:
    """Where the axis of a BHA is farthest from that of the hole.

    Parameters
    ----------
    offset
        Distance of the axis of the BHA from that of the hole, m, positive to the high side.
    position
        Distance from the bit, m.
    hole_radius
        Radius of the hole, m.
    drilled_length
        Drilled length of the bit there, m; nan if it is the same at all lengths.
    """

    offset: float
    position: float
    hole_radius: float
    drilled_length: float

    @property
    def beyond(self) -> float:
        """How far the axis of the BHA is beyond the wall, m; negative inside."""
        return abs(self.offset) - self.hole_radius

    @property
    def outside(self) -> bool:
        """Whether the axis of the BHA leaves the hole."""
        return self.beyond > 0.0

    @property
    def room(self) -> float:
        """How far the axis of the BHA may yet move to the wall, over the radius; negative outside."""
        return -self.beyond / self.hole_radius

    @property
    def side(self) -> str:
        """Where it is, as seen from the axis of the hole."""
        return "below" if self.offset < 0.0 else "above"

    @property
    def warning(self) -> str:
        """What an FMU says of a BHA outside the hole, in one line."""
        return OUTSIDE.format(
            position=f"{self.position:.1f} m",
            offset=f"{1e3 * abs(self.offset):.3g} mm",
            side=self.side,
            when=f" after {self.drilled_length:.1f} m",
            beyond=f"{1e3 * self.beyond:.3g} mm",
        )


def places(reach: float, points: int = POINTS) -> list[float]:
    """Distances from the bit at which a BHA is looked at: evenly spaced, up to the last stabilizer."""
    return [reach * k / (points - 1) for k in range(points)]


class Body:
    """Places along a beam, distances from the bit, and how it is bent there under unit loads. All is dimensionless.

    `shapes` holds for each place the deflections from the axis of the bit under unit loads e_n, F_1 … F_{n−1}, F_RSS,
    sin⟨Θ⟩_1.
    """

    def __init__(self, beam: Beam, s: Sequence[float]) -> None:
        self.beam, self.s = beam, s
        count = len(beam.s) + 2
        units = [[float(i == k) for i in range(count)] for k in range(count)]
        self.shapes = [[beam.shape(s, e_n, F, F_rss, g) for e_n, *F, F_rss, g in units] for s in self.s]


def present_sag(drilling: Drilling, body: Body, hole_radius: float) -> Sag:
    """Where the axis of the BHA is farthest from that of the hole with the bit where it is; a radius in m.

    The distance is eq. (5) at any place along the BHA: e(s) plus the deflection from the axis of the bit.
    """
    p = drilling.integrator
    loads = p.loads()
    theta, Y = p.present.state(p.xi)
    bend = [loads.e[-1], *(row(loads) for row in p.settled(loads).F), loads.F_rss, loads.sin_Theta_1]
    offset, position = 0.0, 0.0
    for s, shape in zip(body.s, body.shapes, strict=True):
        own = Y - p.hole.Y(p.xi - s) - s * theta + dot(shape, bend)
        if abs(own) > abs(offset):
            offset, position = own, s
    length = p.length_scale
    return Sag(offset * length, position * length, hole_radius, drilling.drilled_length)


class Watch:
    """Looks now and then along a run whether the axis of the BHA leaves a hole of some radius, m, and says so once.

    The farther the axis is from the wall, the more of the hole is drilled until it is looked at again. States of a run
    know nothing of that: who goes back and forth hears it once.
    """

    def __init__(self, hole_radius: float) -> None:
        self._hole_radius = hole_radius
        self._body: Body | None = None
        self._next = 0.0  # m drilled; without end once it has been said

    def look(self, drilling: Drilling) -> str:
        """The warning, the first time that there is one; else nothing."""
        if drilling.drilled_length < self._next:
            return ""
        beam = drilling.integrator.modes.beam
        if self._body is None or self._body.beam is not beam:
            self._body = Body(beam, places(beam.lambda_))
        sag = present_sag(drilling, self._body, self._hole_radius)
        reach = beam.lambda_ * drilling.integrator.length_scale
        self._next = inf if sag.outside else drilling.drilled_length + reach * max(sag.room, OFTEN)
        return sag.warning if sag.outside else ""

    def look_soon(self) -> None:
        """Look again after the next step: it may be another hole."""
        self._next = inf if self._next == inf else 0.0
