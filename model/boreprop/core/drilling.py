"""A drilling run in SI units: the shell around the integrator that `simulate` and the FMU share."""

from collections.abc import Iterable
from functools import partial
from math import nan
from typing import Any, Unpack

from .checks import check_number, check_quantity
from .errors import BorepropError, CannotContinue, ParameterError, error_of
from .ground import Ground, check_step
from .inputs import Inputs, Slopes, slopes_of
from .integrator import Integrator
from .modes import Modes, bit_tilt, saturation, wall
from .options import Options, Statistics
from .problems import DERIVED, Problem
from .quantities import ACTING, IN_SPACE_ONLY, ROCK, SLOPES, fields_of
from .survey import Survey
from .system import BitRock, BottomHoleAssembly, epsilon, eta_pi, scale
from .through import GroundIntegrator

Given = tuple[BitRock, float, float, tuple[float, ...]]  # bit and rock, force and active weight, N, and their slopes


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
    options
        How the integrator takes its steps.
    ground
        Layers of rock by depth, and wear; None: the inputs alone say what bit and rock are like.

    Attributes
    ----------
    drilled_length
        Where the bit is, m from the start of the run.
    bit
        Bit and rock at the start.
    integrator
        The integrator, which has dimensionless lengths and forces.

    Raises
    ------
    ParameterError
        If an input is out of range, or a dimensionless number made of the parameters is not finite.
    """

    def __init__(
        self,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        *,
        active_weight_on_bit: float,
        rss_force: float = 0.0,
        options: Options = Options(),  # noqa: B008 - frozen
        ground: Ground | None = None,
    ) -> None:
        self._bha, self.bit, self.ground = bha, bit, ground
        self._length, self._force = bha.length_scale, bha.force_scale
        self.drilled_length = 0.0
        self.clearances = bha.stabilizer_clearances
        self._given: tuple[Any, ...] = ()  # the last inputs that were given, in N, and …
        self._inputs = Inputs(*(nan,) * 4)  # … as the paper's numbers
        if ground:
            bit = ground.bit_in(ground.first_layer, bit)
        scaled, inputs = scale(bha, bit), self._scaled_inputs(bit, rss_force, active_weight_on_bit, slopes_of({}))
        kind = GroundIntegrator if ground else Integrator
        try:
            self.integrator = kind(Modes(scaled), survey, self._length, inputs.F_rss, inputs.eta_pi, options)
        except ParameterError:
            raise
        except (CannotContinue, ArithmeticError, ValueError) as error:  # as in `Integrator.drill`
            raise error_of(Problem("no start", "parameters")) from error
        if ground and isinstance(self.integrator, GroundIntegrator):
            self.integrator.take_ground(ground)

    def _scaled_inputs(self, bit: BitRock, force: float, weight: float, slopes: tuple[float, ...]) -> Inputs:
        """The dimensionless inputs; `ParameterError` if these numbers, or the inputs, are out of range."""
        given = (bit, force, weight, slopes)
        if given == self._given:
            return self._inputs
        l1, F_star, ratio = self._length, self._force, epsilon(bit)
        check_quantity("rss_force", force)
        check_quantity("active_weight_on_bit", weight)
        for name, value in zip(SLOPES, slopes, strict=True):
            check_number(name, value)
        force_slope, weight_slope, eta_slope, chi_slope, limit_slope = slopes
        eta, chi = bit.lateral_steering_resistance, bit.angular_steering_resistance
        stiffness = eta_pi(self._bha, bit, weight)
        inputs = Inputs(
            F_rss=force / F_star,
            eta_pi=stiffness,
            chi_pi=ratio * stiffness,
            psi_star=bit.tilt_limit,
            F_rss_slope=force_slope * l1 / F_star,
            eta_pi_slope=(eta * weight_slope + eta_slope * weight) / F_star * l1,
            chi_pi_slope=(chi * weight_slope + chi_slope * weight) / F_star * l1,
            psi_star_slope=limit_slope * l1,
            eta_pi_curve=eta_slope * weight_slope / F_star * l1 * l1,
            chi_pi_curve=chi_slope * weight_slope / F_star * l1 * l1,
        )
        check_number(DERIVED["scaled_force"], inputs.F_rss)
        check_number(DERIVED["scaled_slope"], inputs.F_rss_slope)
        check_number("eta_pi", inputs.eta_pi, above=0.0)
        check_number(DERIVED["eta_pi_change"], inputs.eta_pi_slope + inputs.eta_pi_curve)
        check_number(DERIVED["chi_pi_change"], inputs.chi_pi_slope + inputs.chi_pi_curve)
        check_number(DERIVED["psi_star_change"], inputs.psi_star_slope)
        check_number(DERIVED["inverse_eta_pi"], 1 / inputs.eta_pi)
        self._given, self._inputs = given, inputs
        return inputs

    def advance(
        self,
        drilled_length: float,
        rss_force: float,
        active_weight_on_bit: float,
        *,
        weight_on_bit: float = 0.0,
        bit: BitRock | None = None,
        **slopes: Unpack[Slopes],
    ) -> None:
        """Drill on under inputs from here, which are constant or linear in the drilled length.

        Parameters
        ----------
        drilled_length
            Where to stop, m from the start of the run. If the bit is there already, only the inputs are taken over.
        rss_force, active_weight_on_bit
            The inputs where the bit is, N.
        weight_on_bit
            All of the weight, N, which acts on a BHA with `axial_load` only, and so not here.
        bit
            Bit and rock where the bit is; None: those of the start.
        slopes
            Changes of force, active weight, and bit and rock per metre drilled.

        Raises
        ------
        ParameterError
            If an input is out of range or the length lies behind the bit.
        CannotContinue
            If the integrator cannot drill on. Nothing has changed then, nor after a `ParameterError`.
        """
        drilled_length, rss_force = float(drilled_length), float(rss_force)  # numpy's own would slow down what follows
        check_quantity("weight_on_bit", weight_on_bit)
        given = (bit or self.bit, rss_force, active_weight_on_bit, slopes_of(slopes))
        inputs = self._scaled_inputs(*given)
        check_number("drilled_length", drilled_length, at_least=self.drilled_length)
        xi, p = drilled_length / self._length, self.integrator
        if isinstance(p, GroundIntegrator):
            p.drill_through(xi, partial(self._inputs_in_ground, p.ground, p.xi, xi, given))
        else:
            p.drill(xi, inputs)
        self.drilled_length = drilled_length

    def _inputs_in_ground(
        self, ground: Ground, start: float, end: float, given: Given, xi: float, layer: int
    ) -> tuple[Inputs, float]:
        """What acts at `xi` in a layer, on a way from `start` to `end` with these given, and up to which place."""
        bit, force, weight, (force_slope, weight_slope, *rock_slopes) = given
        way, length = (xi - start) * self._length, xi * self._length
        active, slope, until = ground.active(length, end * self._length, weight + weight_slope * way, weight_slope)
        rock, slopes = ground.bit_in(layer, bit, rock_slopes, way), (force_slope, slope, *rock_slopes)
        return self._scaled_inputs(rock, force + force_slope * way, active, slopes), until / self._length

    def change_clearances(self, clearances: tuple[float, ...]) -> None:
        """Let the stabilizers have other clearances, m, from where the bit is; errors as in `advance`."""
        if clearances == self.clearances:
            return
        check_quantity("stabilizer_clearance", clearances)
        if len(clearances) != len(self.clearances):
            raise ParameterError("stabilizer_clearance", f"must hold {len(self.clearances)} values", clearances)
        self.integrator.change_clearances(tuple(clearance / self._length for clearance in clearances))
        self.clearances = clearances

    def advance_with(self, clearances: tuple[float, ...], *given: Any, bit: BitRock) -> None:
        """Drill on as by `advance`, with stabilizers that have these clearances, m; all of it or nothing."""
        before = self.save() if clearances != self.clearances else None
        try:
            self.change_clearances(clearances)
            self.advance(*given, bit=bit)
        except BorepropError:
            if before:
                self.restore(before)
            raise

    def follow(
        self,
        lengths: Iterable[float],
        inputs: Any,
        rows: Iterable[int],
        table: Any,
        which: Iterable[int] | None = None,
    ) -> None:
        """Drill leg after leg, each as by `advance`.

        Parameters
        ----------
        lengths
            Where the legs end, m from the start of the run, (legs,), not decreasing.
        inputs
            Inputs where legs start, and their changes per metre, (…, inputs), in the order of `ACTING`.
        rows
            The row of `table` that takes the outputs at the end of each leg, (legs,); −1 for none.
        table
            An array of shape (…, outputs), with the outputs in the order of the table of quantities.
        which
            Which of the inputs are those of each leg, (legs,); without it there are as many as legs, in their order.

        Raises
        ------
        ParameterError, CannotContinue
            As in `advance`, for the leg that fails; the bit is then where the leg before ended.
        """
        rock: tuple[float, ...] = ()
        own = range(len(inputs)) if which is None else which
        for length, k, row in zip(lengths, own, rows, strict=True):
            acting = dict(zip(ACTING, map(float, inputs[k]), strict=True))
            before, rock = rock, tuple(acting[name] for name in ROCK)
            if rock != before:
                bit = BitRock(**fields_of("bit", acting, self._bha.structure))
            planar = {name: value for name, value in acting.items() if name not in (*ROCK, *IN_SPACE_ONLY)}
            self.advance(length, bit=bit, **planar)
            if row >= 0:
                table[row] = tuple(self.outputs().values())

    def step(self) -> None:
        """Drill on to the end of the integrator's next step, under the inputs as they are; errors as in `advance`."""
        check_step(self.ground)
        self.drilled_length = self.integrator.step().end * self._length

    @property
    def statistics(self) -> Statistics:
        """What the integrator has done since the start of the run."""
        return self.integrator.statistics

    def outputs(self) -> dict[str, float | int]:
        """Every output of the table of quantities where the bit is, by scalar name, in the order of the table."""
        p, l1, F_star = self.integrator, self._length, self._force
        scaled = p.scaled
        theta, _ = p.state()
        loads = p.loads()
        mode = p.settled(loads)
        F, delta, F_0 = [row(loads) for row in mode.F], [row(loads) for row in mode.delta], mode.F_0(loads)
        here = p.inputs_here()
        psi = bit_tilt(F_0, here.eta_pi, here.psi_star)
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
        values |= {
            "bit_tilt_saturation": saturation(F_0, here.eta_pi, here.psi_star),
            "bit_lateral_force": F_0 * F_star,
            "bit_moment": -mode.M(loads) * F_star * l1,
            "borehole_curvature": (Theta - p.earlier_inclination(p.xi - 1.0)) / l1,
        }
        values |= self._sensed() | {
            "displacement": x * l1,
            "true_vertical_depth": z * l1,
            "eta_pi": here.eta_pi,
        }
        if isinstance(p, GroundIntegrator) and p.ground.tops:
            values["formation"] = p.layer
        return values

    def _sensed(self) -> dict[str, float]:
        """The outputs of the sensors where the bit is."""
        p, l1, F_star = self.integrator, self._length, self._force
        inclinations, moments, clearances = {}, {}, {}
        for i, (sensor, reading) in enumerate(zip(p.scaled.sensors, p.readings, strict=True), 1):
            inclination, offset, moment = p.sensed(sensor.s, p.xi)
            told = reading.inclination if sensor.interval else inclination + sensor.bias
            inclinations[f"sensor_inclination[{i}]"] = told
            moments[f"sensor_bending_moment[{i}]"] = moment * F_star * l1
            clearances[f"sensor_clearance[{i}]"] = (sensor.clearance - abs(offset)) * l1
        return inclinations | moments | clearances

    def save(self) -> dict[str, Any]:
        """The whole evolving state, of numbers, strings, lists and tuples; JSON keeps it exactly."""
        return {
            "drilled_length": self.drilled_length,
            "clearances": self.clearances,
            "integrator": self.integrator.save(),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go back to a state from `save` of a run with the same parameters."""
        self.drilled_length, self.clearances = state["drilled_length"], tuple(state["clearances"])
        self.integrator.restore(state["integrator"])
