"""A drilling run in SI units: the shell around the propagation that `simulate` and the FMU share."""

from typing import Any

from .checks import check_number, check_quantity
from .errors import ParameterError
from .modes import bit_tilt, left, wall
from .propagation import RELATIVE_TOLERANCE, Propagation
from .survey import Survey
from .system import BitRock, BottomHoleAssembly, eta_pi, scale


def check_inputs(rss_force: float, active_weight_on_bit: float) -> None:
    """Raise `ParameterError` unless the force is finite and the weight finite and positive."""
    check_quantity("rss_force", rss_force)
    check_quantity("active_weight_on_bit", active_weight_on_bit)


def check_tolerance(relative_tolerance: float) -> None:
    """Raise `ParameterError` unless the tolerance is in the range of the table of quantities."""
    check_quantity("relative_tolerance", relative_tolerance)


class Drilling:
    """A borehole as it is drilled, from the end of the survey on.

    Parameters
    ----------
    bha, bit, survey
        The drilling system and the existing hole.
    active_weight_on_bit
        N, positive.
    rss_force
        N, positive builds inclination.
    relative_tolerance
        Local error allowed in one step, relative to 1 rad and to ℓ₁.

    Raises
    ------
    ParameterError
        If an input or the tolerance is out of range, or a dimensionless number made of them is not finite.
    """

    def __init__(
        self,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        *,
        active_weight_on_bit: float,
        rss_force: float = 0.0,
        relative_tolerance: float = RELATIVE_TOLERANCE,
    ) -> None:
        check_inputs(rss_force, active_weight_on_bit)
        check_tolerance(relative_tolerance)
        self._bha, self._bit = bha, bit
        self._length, self._force = bha.length_scale, bha.force_scale
        self.drilled_length = 0.0
        scaled, inputs = scale(bha, bit), self._scaled_inputs(rss_force, active_weight_on_bit)
        try:
            self._propagation = Propagation(scaled, survey, self._length, *inputs, relative_tolerance)
        except ParameterError:
            raise
        except (ArithmeticError, ValueError) as error:  # what other languages call inf and nan
            line = "the state is not finite at 0 m: check inputs and parameters"
            raise ParameterError("parameters", "must give a finite state", line) from error

    def _scaled_inputs(self, rss_force: float, active_weight_on_bit: float) -> tuple[float, float]:
        """F_RSS and ηΠ; `ParameterError` if they are no numbers to go on with."""
        F_rss, own_eta_pi = rss_force / self._force, eta_pi(self._bha, self._bit, active_weight_on_bit)
        check_number("rss_force / F*", F_rss)
        check_number("eta_pi", own_eta_pi, above=0.0)
        check_number("1 / eta_pi", 1 / own_eta_pi)
        return F_rss, own_eta_pi

    def advance(self, drilled_length: float, rss_force: float, active_weight_on_bit: float) -> str | None:
        """Drill on under inputs held from here; None, or one line that says what failed and what helps.

        Parameters
        ----------
        drilled_length
            Where to stop, m from the start of the run. Where the bit is already: only the inputs are taken over.
        rss_force, active_weight_on_bit
            N.

        Raises
        ------
        ParameterError
            If an input is out of range or the length lies behind the bit. Nothing has moved then, nor after a failure.
        """
        check_inputs(rss_force, active_weight_on_bit)
        check_number("drilled_length", drilled_length, at_least=self.drilled_length)
        drilled_length, rss_force = float(drilled_length), float(rss_force)  # numpy's own would slow down what follows
        try:
            inputs = self._scaled_inputs(rss_force, active_weight_on_bit)
        except ParameterError as error:
            return str(error)
        failure = self._propagation.drill(drilled_length / self._length, *inputs)
        if failure is None:
            self.drilled_length = drilled_length
        return failure

    def outputs(self) -> dict[str, float | int]:
        """Every output of the table of quantities where the bit is, by scalar name, in the order of the table."""
        p, l1, F_star = self._propagation, self._length, self._force
        scaled = p.scaled
        theta, _ = p.state()
        loads = p.loads()
        mode = p.settled(loads)
        F, delta, F_0 = [row(loads) for row in mode.F], [row(loads) for row in mode.delta], mode.F_0(loads)
        psi_star = scaled.psi_star
        psi = bit_tilt(F_0, p.eta_pi, psi_star)
        Theta = theta - psi
        # λ_i (⟨Θ⟩_i − θ) = e_i − e_{i−1}
        offsets = [0.0, *loads.e]
        averages = [theta + (offsets[i + 1] - offsets[i]) / lambda_i for i, lambda_i in enumerate(scaled.lambda_)]
        x, z = p.position()
        values: dict[str, float | int] = {
            "drilled_length": self.drilled_length,
            "bit_inclination": theta,
            "borehole_inclination": Theta,
            "bit_tilt": psi,
        }
        values |= {f"average_inclination[{i}]": average for i, average in enumerate(averages, 1)}
        values |= {f"stabilizer_deflection[{i}]": d * l1 for i, d in enumerate(delta, 1)}
        values |= {f"stabilizer_force[{i}]": f * F_star for i, f in enumerate(F, 1)}
        values |= {f"stabilizer_contact[{i}]": wall(f) for i, f in enumerate(F, 1)}
        return values | {
            "bit_tilt_saturation": left(F_0 / p.eta_pi, -psi_star, psi_star),
            "bit_lateral_force": F_0 * F_star,
            "bit_moment": -mode.M(loads) * F_star * l1,
            "borehole_curvature": (Theta - p.earlier_inclination(p.xi - 1.0)) / l1,
            "displacement": x * l1,
            "true_vertical_depth": z * l1,
            "eta_pi": p.eta_pi,
        }

    def save(self) -> dict[str, Any]:
        """The whole evolving state, of numbers, strings, lists and tuples; JSON keeps it exactly."""
        return {"drilled_length": self.drilled_length, "propagation": self._propagation.save()}

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a state from `save` of a run with the same parameters."""
        self.drilled_length = state["drilled_length"]
        self._propagation.restore(state["propagation"])
