"""The inputs of the integrator: what acts on the bit besides the hole, constant or changing along the way."""

from collections.abc import Iterator, Mapping
from math import sqrt
from typing import NamedTuple, TypedDict, cast

from .quantities import SLOPES

SAME = 1e-12  # relative: what differs by less differs by rounding


class Slopes(TypedDict, total=False):
    """Changes of what a run is given, per metre drilled; 0 where one is left out."""

    rss_force_slope: float
    active_weight_on_bit_slope: float
    lateral_steering_resistance_slope: float
    angular_steering_resistance_slope: float
    bit_tilt_limit_slope: float


def slopes_of(given: Slopes) -> tuple[float, ...]:
    """All slopes, in the order of the table of quantities."""
    named = cast(Mapping[str, float], given)
    for name in named:
        if name not in SLOPES:
            raise TypeError(f"{name}: must be one of {', '.join(SLOPES)}")
    return tuple(named.get(name, 0.0) for name in SLOPES)


class Inputs(NamedTuple):
    """F_RSS, ηΠ, χΠ = εηΠ and ψ* where they were taken over, and how they change along the way.

    F_RSS and ψ* have a change per ξ. ηΠ and χΠ are products of two such: they have one per ξ and one per ξ².
    """

    F_rss: float
    eta_pi: float
    chi_pi: float
    psi_star: float
    F_rss_slope: float = 0.0
    eta_pi_slope: float = 0.0
    chi_pi_slope: float = 0.0
    psi_star_slope: float = 0.0
    eta_pi_curve: float = 0.0
    chi_pi_curve: float = 0.0

    @property
    def epsilon(self) -> float:
        """ε = χ/η."""
        return self.chi_pi / self.eta_pi

    @property
    def ramp(self) -> bool:
        """Whether they change along the way."""
        return any(self[4:])

    @property
    def law_changes(self) -> bool:
        """Whether more of them changes than the force, so that the law is another from place to place."""
        return any(self[5:])

    @property
    def growth(self) -> float:
        """The largest share per ξ by which ηΠ, χΠ or ψ* changes, at first and at most on a short way."""
        eta = abs(self.eta_pi_slope / self.eta_pi) + sqrt(abs(self.eta_pi_curve / self.eta_pi))
        chi = abs(self.chi_pi_slope / self.chi_pi) + sqrt(abs(self.chi_pi_curve / self.chi_pi))
        return max(eta, chi, abs(self.psi_star_slope / self.psi_star))

    def changes_law(self, before: "Inputs") -> bool:
        """Whether the law is another under them, which the force alone does not make it."""
        return self[1:4] != before[1:4] or self.law_changes or before.law_changes

    def eta_pi_at(self, way: float) -> float:
        """ηΠ a length `way` ahead."""
        return self.eta_pi + way * (self.eta_pi_slope + way * self.eta_pi_curve)

    def chi_pi_at(self, way: float) -> float:
        """χΠ a length `way` ahead."""
        return self.chi_pi + way * (self.chi_pi_slope + way * self.chi_pi_curve)

    def psi_star_at(self, way: float) -> float:
        """ψ* a length `way` ahead."""
        return self.psi_star + way * self.psi_star_slope

    def ahead(self, way: float) -> "Inputs":
        """The inputs a length `way` ahead of where they were taken over."""
        if not self.ramp:
            return self
        return self._replace(
            F_rss=self.F_rss + self.F_rss_slope * way,
            eta_pi=self.eta_pi_at(way),
            chi_pi=self.chi_pi_at(way),
            psi_star=self.psi_star_at(way),
            eta_pi_slope=self.eta_pi_slope + 2 * way * self.eta_pi_curve,
            chi_pi_slope=self.chi_pi_slope + 2 * way * self.chi_pi_curve,
        )

    def same(self, other: "Inputs", way: float) -> bool:
        """Whether other inputs are the same along a way."""
        if not self.ramp and not other.ramp:
            return self == other
        for (a, a_slope, a_curve), (b, b_slope, b_curve) in zip(self._ramps(), other._ramps(), strict=True):
            end = b + way * (b_slope + way * b_curve)
            off = abs(a - b) + way * (abs(a_slope - b_slope) + way * abs(a_curve - b_curve))
            if not off <= SAME * max(abs(b), abs(end)):
                return False
        return True

    def _ramps(self) -> Iterator[tuple[float, float, float]]:
        """Each of them with its changes per ξ and per ξ²."""
        return zip(self[:4], self[4:8], (0.0, self.eta_pi_curve, self.chi_pi_curve, 0.0), strict=True)
