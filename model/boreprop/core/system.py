"""The drilling system in SI units, and the paper's dimensionless numbers made from it."""

from dataclasses import dataclass
from itertools import pairwise

from .checks import check_increasing, check_number, check_part, take_fields
from .errors import ParameterError, error_of
from .problems import CONSTRAINTS, DERIVED, Problem
from .quantities import MAX_POINTS, MAX_SECTIONS, MAX_SENSORS, PARAMETERS, Structure
from .quantities import MAX_STABILIZERS as MAX_STABILIZERS
from .sensors import Sensor

LEAST_SPAN = 0.01  # m between stabilizers, at least: none stand closer, and the forces there would be rounding errors


@dataclass(frozen=True)
class BottomHoleAssembly:
    """The elastic beam between the bit and the last stabilizer.

    Parameters
    ----------
    stabilizer_positions
        Distance of stabilizers 1…n from the bit, m, increasing by at least 0.01 m, 1 <= n <= 6. The last one is
        ideal (centred and hinged).
    stabilizer_clearances
        Clearance y*_i between blade and wall on each side of a centred stabilizer, m, one for each of the
        n − 1 non-ideal stabilizers.
    rss_position
        Distance of the steering pads from the bit, m, between the bit and the first stabilizer.
    distributed_weight
        Buoyant weight per length, N/m; of a beam in sections that of the section at the bit, whatever is given.
    flexural_stiffness
        EI, N·m²; likewise.
    section_lengths, section_distributed_weights, section_flexural_stiffnesses
        A beam in up to 24 sections, from the bit up: length, m, weight per length, N/m, and EI, N·m², of each. Together
        they are at least as long as the BHA. Without any the beam is uniform.
    section_outer_diameters
        Outer diameter of each section, m; 0 where it is not known.
    body_point_positions, body_point_clearances
        Up to 128 points of the body between the stabilizers at which it may touch the wall: distance from the bit, and
        clearance on each side of a centred body, m. Without any it never touches, assumption 5 of the paper.
    end_deflection
        Of a beam in sections: how far from the axis of the hole the last stabilizer holds it, m, positive to the high
        side. A string that lies on the low side of the hole there is off by the clearance of its body.
    axial_load
        Whether the weight on bit, and the weight along the hole, press and pull the beam, which makes it softer and
        stiffer. Only the native engine has this, sections and points of the body.
    sensor_positions
        Distance of up to 8 sensors from the bit, m, in any order, up to the last stabilizer.
    sensor_intervals, sensor_biases, sensor_noises, sensor_seeds
        How each reads the inclination: every so many metres drilled, from the start of the run on (0: all the time);
        what is always added, rad; the standard deviation of what is added to each reading, rad, which needs an
        interval; and which noise that is, 0 to 2³¹ − 1. Left out they are 0.
    sensor_body_clearances
        Clearance of a centred body on each side at each sensor, m. Where it is 0, a `Case` puts that of the section
        there, or the radius of the hole if no diameter is known.

    Raises
    ------
    ParameterError
        If a value breaks one of these constraints.
    """

    stabilizer_positions: tuple[float, ...]
    stabilizer_clearances: tuple[float, ...]
    rss_position: float
    distributed_weight: float
    flexural_stiffness: float
    section_lengths: tuple[float, ...] = ()
    section_distributed_weights: tuple[float, ...] = ()
    section_flexural_stiffnesses: tuple[float, ...] = ()
    section_outer_diameters: tuple[float, ...] = ()
    body_point_positions: tuple[float, ...] = ()
    body_point_clearances: tuple[float, ...] = ()
    end_deflection: float = 0.0
    axial_load: bool = False
    sensor_positions: tuple[float, ...] = ()
    sensor_intervals: tuple[float, ...] = ()
    sensor_biases: tuple[float, ...] = ()
    sensor_noises: tuple[float, ...] = ()
    sensor_seeds: tuple[int, ...] = ()
    sensor_body_clearances: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        take_fields("bha", self)
        if self.section_lengths:
            self._take_sections()
        self._take_sensors()
        n = len(self.stabilizer_positions)
        if not 1 <= n <= MAX_STABILIZERS:
            constraint = CONSTRAINTS["wrong count"][0].format(limit=MAX_STABILIZERS)
            raise ParameterError("stabilizer_position", constraint, self.stabilizer_positions)
        if len(self.stabilizer_clearances) != n - 1:
            raise ParameterError(
                "stabilizer_clearance",
                f"must hold one value per non-ideal stabilizer, here {n - 1}",
                self.stabilizer_clearances,
            )
        check_part("bha", self)
        check_increasing("stabilizer_position", self.stabilizer_positions)
        for before, after in pairwise((0.0, *self.stabilizer_positions)):
            if after - before < LEAST_SPAN * (1 - 1e-9):  # 4.34 and 4.35 are that far apart, but for rounding
                raise error_of(Problem("too close", "stabilizer_position", 0, after, before, LEAST_SPAN))
        check_number("rss_position", self.rss_position, at_most=self.length_scale)
        self._check_body()
        self._check_sensors()

    def _take_sensors(self) -> None:
        """Put zeros for what is left out of the sensors, and check how many values there are."""
        count = len(self.sensor_positions)
        if count > MAX_SENSORS:
            raise ParameterError("sensor_position", f"must hold at most {MAX_SENSORS} values", self.sensor_positions)
        for name in ("intervals", "biases", "noises", "seeds", "body_clearances"):
            field = f"sensor_{name}"
            values = getattr(self, field)
            if not values:
                object.__setattr__(self, field, (0,) * count if name == "seeds" else (0.0,) * count)
            elif len(values) != count:
                quantity = next(quantity.name for quantity in PARAMETERS if quantity.attribute == field)
                raise ParameterError(quantity, f"must hold one value per sensor, here {count}", values)

    def _check_sensors(self) -> None:
        """Check the sensors together with the BHA."""
        rows = zip(self.sensor_positions, self.sensor_intervals, self.sensor_noises, self.sensor_seeds, strict=True)
        for index, (position, interval, noise, seed) in enumerate(rows, 1):
            check_number("sensor_position", position, index=index, at_most=self.stabilizer_positions[-1])
            if noise:
                check_number("sensor_interval", interval, index=index, above=0.0)
            if seed != int(seed):
                raise ParameterError(f"sensor_seed[{index}]", "must be a whole number", seed)
        object.__setattr__(self, "sensor_seeds", tuple(map(int, self.sensor_seeds)))

    def _check_body(self) -> None:
        """Check the points of the body together."""
        positions, count = self.body_point_positions, len(self.body_point_positions)
        if len(self.body_point_clearances) != count:
            constraint = f"must hold one value per point of the body, here {count}"
            raise ParameterError("body_point_clearance", constraint, self.body_point_clearances)
        if count > MAX_POINTS:
            raise ParameterError("body_point_position", f"must hold at most {MAX_POINTS} values", positions)
        check_increasing("body_point_position", positions)
        for position in positions[-1:]:
            check_number("body_point_position", position, index=count, at_most=self.stabilizer_positions[-1])

    def _take_sections(self) -> None:
        """Check the sections together, and take weight and stiffness of the one at the bit."""
        count, reach = len(self.section_lengths), self.stabilizer_positions[-1:]
        columns = {
            "section_distributed_weight": self.section_distributed_weights,
            "section_flexural_stiffness": self.section_flexural_stiffnesses,
            "section_outer_diameter": self.section_outer_diameters,
        }
        for name, values in columns.items():
            if len(values) != count:
                raise ParameterError(name, f"must hold one value per section, here {count}", values)
        if count > MAX_SECTIONS:
            raise ParameterError("section_length", f"must hold at most {MAX_SECTIONS} values", self.section_lengths)
        if reach and sum(self.section_lengths) < reach[0] * (1 - 1e-9):
            raise error_of(Problem("out of reach", "section_length", value=sum(self.section_lengths), limit=reach[0]))
        object.__setattr__(self, "distributed_weight", self.section_distributed_weights[0])
        object.__setattr__(self, "flexural_stiffness", self.section_flexural_stiffnesses[0])

    @property
    def structure(self) -> Structure:
        """How it is made up; what a case adds to that, layers of rock, it does not know."""
        return Structure(
            len(self.stabilizer_positions),
            len(self.section_lengths),
            int(self.axial_load),
            len(self.body_point_positions),
            sensors=len(self.sensor_positions),
        )

    @property
    def length_scale(self) -> float:
        """ℓ₁, m: the distance from the bit to the first stabilizer."""
        return self.stabilizer_positions[0]

    @property
    def half_length(self) -> float:
        """Half the distance from the bit to the last stabilizer, m.

        Mean inclinations, chords and doglegs of a hole are over this length. Unlike ℓ₁, it does not change with a
        stabilizer that never touches the wall.
        """
        return self.stabilizer_positions[-1] / 2

    @property
    def force_scale(self) -> float:
        """F* = 3EI/ℓ₁², N."""
        return 3.0 * self.flexural_stiffness / (self.length_scale * self.length_scale)


@dataclass(frozen=True)
class BitRock:
    """The bit–rock interaction law, eqs. (9) to (11).

    Parameters
    ----------
    lateral_steering_resistance
        η = H₂/H₁: lateral against axial drilling resistance, dimensionless.
    angular_steering_resistance
        χ = H₃/H₁, dimensionless.
    tilt_limit
        ψ*: the tilt at which the bit gauge meets the hole wall, rad.
    walk_angle
        ϖ: the angle from the lateral penetration of the bit to the lateral force, positive from the high side to the
        right looking down the hole, rad. What drills in a plane has none.

    Raises
    ------
    ParameterError
        If a value is not positive, or the tilt limit exceeds a right angle, or the walk angle 89°.
    """

    lateral_steering_resistance: float
    angular_steering_resistance: float
    tilt_limit: float
    walk_angle: float = 0.0

    def __post_init__(self) -> None:
        take_fields("bit", self)
        check_part("bit", self)


@dataclass(frozen=True)
class Scaled:
    """The drilling system in the paper's numbers: lengths over ℓ₁, forces over F*, moments over F*ℓ₁.

    Bit and rock, ε and ψ*, are those at the start: the integrator has them among its inputs.
    """

    s: tuple[float, ...]  # s_1 … s_n, distance of the stabilizers from the bit; s_1 = 1
    y_star: tuple[float, ...]  # y*_1 … y*_{n-1}
    Delta: float  # distance of the RSS from the bit
    w: float  # w̃ = w ℓ₁ / F*
    epsilon: float  # ε = χ/η
    psi_star: float  # ψ*, rad
    sensors: tuple[Sensor, ...] = ()

    @property
    def lambda_(self) -> tuple[float, ...]:
        """λ_1 … λ_n: distance from stabilizer i−1 (0 is the bit) to stabilizer i."""
        return tuple(after - before for before, after in pairwise((0.0, *self.s)))


def check_in_plane(bit: BitRock) -> None:
    """Raise `ParameterError` if the bit walks, for then nothing stays in a plane."""
    if bit.walk_angle:
        constraint = "must be 0 for what drills in a plane; boreprop spiral takes it"
        raise ParameterError("bit_walk_angle", constraint, bit.walk_angle)


def scale(bha: BottomHoleAssembly, bit: BitRock) -> Scaled:
    """The dimensionless numbers of a drilling system that drills in a plane, section II of the paper.

    Raises
    ------
    ParameterError
        If one of them is not finite, though the parameters are in their ranges, the beam is not the paper's, or the bit
        walks.
    """
    check_in_plane(bit)
    if not bha.structure.is_of_the_paper:
        raise ParameterError(
            "bha",
            "must be the paper's uniform beam here; for others there are simulate with the native engine, summary, "
            "steering, dogleg, hysteresis, study, boreprop-view and, without body contact, roots, stability and spiral",
            bha.structure.beyond_the_paper,
        )
    l1 = bha.length_scale
    check_number(DERIVED["force_scale"], bha.force_scale, above=0.0)
    s = tuple(position / l1 for position in bha.stabilizer_positions)
    w = bha.distributed_weight * l1 / bha.force_scale
    check_number(DERIVED["scaled_reach"], s[-1])
    check_number(DERIVED["scaled_weight"], w)
    return Scaled(
        s=s,
        y_star=tuple(clearance / l1 for clearance in bha.stabilizer_clearances),
        Delta=bha.rss_position / l1,
        w=w,
        epsilon=epsilon(bit),
        psi_star=bit.tilt_limit,
        sensors=tuple(
            Sensor(position / l1, interval / l1, bias, noise, int(seed), clearance / l1)
            for position, interval, bias, noise, seed, clearance in zip(
                bha.sensor_positions,
                bha.sensor_intervals,
                bha.sensor_biases,
                bha.sensor_noises,
                bha.sensor_seeds,
                bha.sensor_body_clearances,
                strict=True,
            )
        ),
    )


def epsilon(bit: BitRock) -> float:
    """ε = χ/η; `ParameterError` if it or its inverse is not finite, though χ and η are in their ranges."""
    value = bit.angular_steering_resistance / bit.lateral_steering_resistance
    check_number(DERIVED["epsilon"], value, above=0.0)
    check_number(DERIVED["inverse_epsilon"], 1 / value)
    return value


def eta_pi(bha: BottomHoleAssembly, bit: BitRock, active_weight_on_bit: float) -> float:
    """ηΠ, the active weight on bit (N) over F*, times the lateral steering resistance."""
    return bit.lateral_steering_resistance * active_weight_on_bit / bha.force_scale
