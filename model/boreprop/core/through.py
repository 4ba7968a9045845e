"""Drills through ground: where the bit goes from one layer into another is an event."""

from collections.abc import Callable
from typing import Any

from .ground import STAY, Ground, first_exit
from .inputs import Inputs
from .integrator import Integrator

CLOSE = 1e-9  # m: a bit this little beyond the bound of a layer, by rounding, is at it


class GroundIntegrator(Integrator):
    """An `Integrator` that knows in which layer of the ground the bit is. `take_ground` is to be called first."""

    ground: Ground
    layer: int  # in which the bit is

    def take_ground(self, ground: Ground) -> None:
        """Take the ground over that is to be drilled."""
        self.ground, self.layer, self.stay = ground, ground.first_layer, 0.0

    def drill_through(self, xi: float, inputs_at: Callable[[float, int], tuple[Inputs, float]]) -> None:
        """Drill on to `xi` where `inputs_at` tells for a place and a layer what acts, and up to which place.

        Errors as in `drill`.
        """
        with self._all_or_nothing():
            while True:
                inputs, until = inputs_at(self.xi, self.layer)
                end = min(xi, until)
                if not self.inputs_here().same(inputs, end - self.xi if end > self.xi else 1.0):
                    self._steer(inputs)
                if not self._leave_layer(end):
                    self.xi = end
                    self._read(end)
                    if end == xi:
                        return

    def _leave_layer(self, end: float) -> bool:
        """Take steps up to `end`, but no farther than where the bit leaves its layer; whether it did."""
        upper, lower = self.ground.bounds(self.layer)
        bounds = upper / self.length_scale, lower / self.length_scale
        last = self._accepted + self.options.most_steps
        while True:
            left = first_exit(self.present, self.path[1], bounds, max(self.present.xi, self.stay))
            if left and left.xi <= end:
                break
            if end <= self.present.end:
                return False
            self._check_way(end, last)
            self._take_step()
        self.xi = left.xi
        self._read(self.xi)
        self.layer += left.side
        depth = self.position()[1] * self.length_scale
        while left.side * (depth - self.ground.bounds(self.layer)[left.side > 0]) > CLOSE:  # through a thin layer
            self.layer += left.side
        self.stay = self.xi + STAY / self.length_scale
        return True

    def save(self) -> dict[str, Any]:
        """The whole evolving state, see `Integrator.save`."""
        return super().save() | {"layer": (self.layer, self.stay)}

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a state from `save`."""
        super().restore(state)
        self.layer, self.stay = state["layer"]
