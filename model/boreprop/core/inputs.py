"""The inputs of the integrator: what acts on the bit besides the hole, constant or linear along the way."""

from typing import NamedTuple

SAME = 1e-12  # relative: ramps that differ by less at both ends of a way differ by rounding


class Inputs(NamedTuple):
    """F_RSS and ηΠ where they were taken over, and their changes per ξ."""

    F_rss: float
    eta_pi: float
    F_rss_slope: float = 0.0
    eta_pi_slope: float = 0.0

    @property
    def ramp(self) -> bool:
        """Whether they change along the way."""
        return self.F_rss_slope != 0 or self.eta_pi_slope != 0

    def ahead(self, way: float) -> "Inputs":
        """The inputs a length `way` ahead of where they were taken over."""
        if not self.ramp:
            return self
        return self._replace(F_rss=self.F_rss + self.F_rss_slope * way, eta_pi=self.eta_pi + self.eta_pi_slope * way)

    def same(self, other: "Inputs", way: float) -> bool:
        """Whether other inputs are the same along a way."""
        if not self.ramp and not other.ramp:
            return self == other
        mine, others = self.ahead(way), other.ahead(way)
        for a, a_end, b, b_end in zip(self[:2], mine[:2], other[:2], others[:2], strict=True):
            most = SAME * max(abs(b), abs(b_end))
            if abs(a - b) > most or abs(a_end - b_end) > most:
                return False
        return True
