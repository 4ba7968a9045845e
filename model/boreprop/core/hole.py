"""The hole behind the bit: the survey of the existing hole, the drilled history, and the delayed look-up."""

from bisect import bisect_right
from math import inf
from typing import Any, NamedTuple

from .checks import check_number
from .inputs import Inputs
from .problems import DERIVED
from .survey import Survey


class Drilled(NamedTuple):
    """How a piece of the hole was drilled: with θ = Σ theta[m] t^m, t as in `Hole`, under which inputs at its start."""

    theta: tuple[float, ...]
    inputs: Inputs

    def at(self, t: float) -> float:
        """θ at `t`."""
        c0, c1, c2, c3, c4, c5 = self.theta
        return c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))


class Hole:
    """The borehole's lateral coordinate Y(ξ) = ∫Θ dξ as polynomial pieces, oldest first.

    Piece k covers ξ from starts[k] to the start of the next one; there Y = Σ coefficients[k][m] t^m with
    t = (ξ − starts[k]) · rates[k]. Y counts from an origin that moves with the bit, so only differences mean anything.
    drilled[k] is None if piece k comes from the survey.
    """

    def __init__(self, survey: Survey, length_scale: float, reach: float) -> None:
        """Take the last `reach` (in ℓ₁) of the survey; the bit is at ξ = 0, where Y = 0.

        `ParameterError` if two stations are so close that ℓ₁ over their distance is not finite.
        """
        bit_depth = survey.measured_depth[-1]
        stations = [(depth - bit_depth) / length_scale for depth in survey.measured_depth]
        inclinations = list(survey.inclination)
        if stations[0] >= -reach:
            stations.insert(0, min(stations[0], -reach) - 1.0)
            inclinations.insert(0, inclinations[0])
        first = max(bisect_right(stations, -reach) - 1, 0)
        stations, inclinations = stations[first:], inclinations[first:]
        self.starts = stations[:-1]
        self.rates: list[float] = []
        self.coefficients: list[tuple[float, ...]] = []
        self.drilled: list[Drilled | None] = [None] * len(self.starts)
        Y = 0.0
        for k in range(len(stations) - 2, -1, -1):
            width = stations[k + 1] - stations[k]
            slope, bend = inclinations[k] * width, (inclinations[k + 1] - inclinations[k]) * width / 2
            Y -= slope + bend
            rate = 1 / width if width else inf
            check_number(DERIVED["station_rate"], rate)
            self.rates.insert(0, rate)
            self.coefficients.insert(0, (Y, slope, bend, 0.0, 0.0, 0.0))
        slopes = [(b - a) * rate for a, b, rate in zip(inclinations, inclinations[1:], self.rates, strict=False)]
        self.kinks = [
            (xi, abs(after - before)) for xi, before, after in zip(stations[1:-1], slopes, slopes[1:], strict=False)
        ]
        self.final_inclination = inclinations[-1]

    def append(self, start: float, width: float, coefficients: tuple[float, ...], drilled: Drilled) -> None:
        """Add the piece drilled from `start`; the piece before ends there."""
        self.starts.append(start)
        self.rates.append(1 / width)
        self.coefficients.append(coefficients)
        self.drilled.append(drilled)

    def find(self, xi: float) -> int:
        """Index of the piece that covers `xi`."""
        return bisect_right(self.starts, xi) - 1

    def Y(self, xi: float) -> float:
        """Lateral coordinate of the hole axis at `xi`."""
        k = self.find(xi)
        t = (xi - self.starts[k]) * self.rates[k]
        c0, c1, c2, c3, c4, c5 = self.coefficients[k]
        return c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))

    def Theta(self, xi: float) -> float:
        """Y' at `xi`, the inclination; of drilled hole, within the error of a step between its nodes."""
        k = self.find(xi)
        t = (xi - self.starts[k]) * self.rates[k]
        _, c1, c2, c3, c4, c5 = self.coefficients[k]
        return (c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))) * self.rates[k]

    def look_up(self, xi: float, h: float, points: list[float]) -> list[float]:
        """Y at `xi` + t h for increasing points t: one search, then a walk from piece to piece."""
        starts, rates, coefficients = self.starts, self.rates, self.coefficients
        last = len(starts) - 1
        k = bisect_right(starts, xi) - 1
        start, rate = starts[k], rates[k]
        end = starts[k + 1] if k < last else inf
        c0, c1, c2, c3, c4, c5 = coefficients[k]
        values = []
        for point in points:
            at = xi + point * h
            if at > end:
                while at > end:
                    k += 1
                    end = starts[k + 1] if k < last else inf
                start, rate = starts[k], rates[k]
                c0, c1, c2, c3, c4, c5 = coefficients[k]
            t = (at - start) * rate
            values.append(c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))))
        return values

    def forget(self, xi: float) -> None:
        """Drop the pieces that end before `xi`."""
        first = self.find(xi)
        del self.starts[:first], self.rates[:first], self.coefficients[:first], self.drilled[:first]

    def shift(self, Y: float) -> None:
        """Move the origin of the lateral coordinate by `Y`."""
        self.coefficients = [(c[0] - Y, *c[1:]) for c in self.coefficients]

    def save(self) -> dict[str, Any]:
        """The pieces, as plain lists."""
        return {
            "starts": self.starts[:],
            "rates": self.rates[:],
            "coefficients": self.coefficients[:],
            "drilled": self.drilled[:],
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Take over the pieces from `save`."""
        self.starts, self.rates = list(state["starts"]), list(state["rates"])
        self.coefficients = [tuple(c) for c in state["coefficients"]]
        self.drilled = [piece and Drilled(tuple(piece[0]), Inputs(*piece[1])) for piece in state["drilled"]]
