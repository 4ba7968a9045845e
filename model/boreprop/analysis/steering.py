"""Steering: the curvature of the hole under a constant force of the pads, the bit tilt and the contacts.

In a hole of constant curvature, Θ(ξ−s) = Θ − κ s, the offsets of the beam are e_i = −s_i ψ − s_i² κ/2, and θ' = κ.
In a regime of contacts and saturation, (14) and (17) are then two linear equations for κ and ψ,

    (εηΠ + M₂) κ +      M₁ ψ = M_rss F_RSS + M_g sin⟨Θ⟩_1 + M_const ,       M₁ = Σ M_i s_i ,  M₂ = Σ M_i s_i²/2
            F₂ κ + (ηΠ + F₁) ψ = F0_rss F_RSS + F0_g sin⟨Θ⟩_1 + F0_const ,  F₁ = Σ F0_i s_i , F₂ = Σ F0_i s_i²/2

with the second one replaced by ψ = ±ψ* where the tilt saturates.

There is one response to each force. The determinant is positive in every regime at every ηΠ > 0: the beam is a cubic
spline, clamped at the bit and hinged at the last support, and its moments at the supports follow the spline's
tridiagonal equations. So M₁, M₂ and F₁ are positive, and between the bit and the first support the moment of a tilt
passes zero while that of a curvature does not, so M₂ F₁ − M₁ F₂ >= 0. Determinants of one sign in all regimes make κ
and ψ the solution of a linear complementarity problem with a P-matrix: it exists, it is unique, and least-index
pivoting finds it. So the build rate is a continuous, piecewise linear function of the force. Whether the hole
approaches this response is a question of stability.

The response may be reversed. Without saturation dκ/dF_RSS has the numerator M_rss (ηΠ + F₁) − M₁ F0_rss, which is zero
at ηΠ = M₁ F0_rss/M_rss − F₁ > 0; without contact that is 2/(Δ(2λ − Δ)). At larger ηΠ a push to the high side drops the
hole: the bit hardly moves sideways and turns as the clamped end of the pushed beam. If the tilt is saturated it does
not change with the force, and the sign is that of M_rss <= 0 at any ηΠ.

Gravity acts through sin⟨Θ⟩_1 alone, which changes along the arc. The response here is quasi-steady: sin⟨Θ⟩_1 is taken
as constant. That is exact without weight and where κ = 0; otherwise `build_rate_error` is the leading term of what is
neglected.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import cos, inf, nan, sin

import numpy as np

from ..case.case import Case
from ..core.checks import check_number, check_quantity
from ..core.errors import ParameterError
from ..core.linear import dot
from ..core.modes import ROUNDING, Bound, Loads, Mode, Modes, Regime, Row, wall
from ..core.system import BottomHoleAssembly, Scaled, scale
from .lying import CLOSE, steady_lie, supports_of

MOST_PIECES = 1000  # of the curve, so that the way along it ends: there are at most 729 regimes, few of them met twice


@dataclass(frozen=True)
class SteadyResponse:
    """The steady response to a force: a hole of constant curvature, with the tilt and the contacts that drill it.

    Parameters
    ----------
    rss_force
        Force of the steering pads, N, positive to the high side.
    build_rate
        Change of inclination per drilled length, rad/m.
    build_rate_error
        Leading term of the difference between the true build rate at the bit and `build_rate`, rad/m. It arises since
        gravity changes along the arc. nan for a beam that is not the paper's.
    bit_tilt
        ψ, rad.
    bit_tilt_saturation
        1 at +ψ*, −1 at −ψ*, 0 in between.
    stabilizer_contact
        For each non-ideal stabilizer 1 on the lower wall, −1 on the upper wall, 0 free, shape (n − 1,). A stabilizer
        without clearance is on the wall that pushes it.
    stabilizer_force
        Force of the wall on each non-ideal stabilizer, N, shape (n − 1,), positive from the lower wall.
    stabilizer_deflection
        Deflection of each non-ideal stabilizer from the hole axis, m, shape (n − 1,), positive to the high side.
    body_contact_force, body_contact_position
        The largest force of the wall on the body of the BHA, N, and where it acts, m from the bit; 0 if there is none.
    """

    rss_force: float
    build_rate: float
    build_rate_error: float
    bit_tilt: float
    bit_tilt_saturation: int
    stabilizer_contact: tuple[int, ...]
    stabilizer_force: tuple[float, ...]
    stabilizer_deflection: tuple[float, ...]
    body_contact_force: float = 0.0
    body_contact_position: float = 0.0


@dataclass(frozen=True)
class Piece:
    """A straight piece of the curve of build rate over force: contacts and saturation do not change along it.

    Parameters
    ----------
    start, end
        The responses at its ends, the smaller force first.
    gain
        Slope of the piece: change of the build rate per force, rad/m per N.
    reversal_eta_pi, reversal_weight
        The ηΠ, and the active weight on bit in N, above which the gain is negative: inf if it never is, 0 where the
        tilt is saturated.
    """

    start: SteadyResponse
    end: SteadyResponse
    gain: float
    reversal_eta_pi: float
    reversal_weight: float


def steady_response(case: Case, rss_force: float, inclination: float, *, gravity: bool = True) -> SteadyResponse:
    """Find the hole of constant curvature that a constant force drills at a given inclination.

    It solves (14) and (17) with the contacts (7, 8) and the saturation (11); see the module's docstring.

    Parameters
    ----------
    case
        The drilling system and its active weight on bit. The existing hole, the schedule and the length have no
        influence.
    rss_force
        Force of the steering pads, N, positive to the high side.
    inclination
        ⟨Θ⟩_1, the inclination of the hole averaged over the ℓ₁ behind the bit, rad.
    gravity
        False leaves out the weight of the BHA.

    Returns
    -------
    SteadyResponse
        The response, in SI units. It exists for every force, and there is only one.

    Raises
    ------
    ParameterError
        If a value is not finite, or the BHA buckles under its axial load.
    KernelError
        If the BHA is not the paper's uniform beam, and the native engine cannot be used.

    Examples
    --------
    >>> from math import degrees, radians
    >>> from boreprop import paper_case, steady_response
    >>> response = steady_response(paper_case(), rss_force=10e3, inclination=radians(30.0))
    >>> round(30 * degrees(response.build_rate), 2)  # ° over 30 m
    5.09
    >>> response.stabilizer_contact, response.bit_tilt_saturation
    ((-1,), 0)
    """
    check_number("rss_force", rss_force)
    if not case.bha.structure.is_of_the_paper:
        [response] = responses_as_built(case, (rss_force,), inclination, gravity=gravity)
        return response
    steady = _steady(case, inclination, gravity)
    return _in_si(case.bha, steady.line_at(rss_force / case.bha.force_scale), rss_force)


def responses_as_built(
    case: Case, rss_forces: Sequence[float], inclination: float, *, gravity: bool = True
) -> tuple[SteadyResponse, ...]:
    """`steady_response` to each of some forces, with whatever the BHA has of sections, axial load and body contact."""
    check_quantity("inclination", inclination)
    forces, count = np.array(rss_forces), len(case.bha.stabilizer_positions) - 1
    found = steady_lie(case, forces, inclination, gravity=gravity)
    s = supports_of(case.bha)
    offsets = -np.outer(found.tilt, s) - np.outer(found.curvature, s**2 / 2)
    deflections = (offsets[:, : count + 1] + found.lie.shape)[:, :count]
    responses = []
    for row, force in enumerate(forces.tolist()):
        on_stabilizers, on_body = found.lie.forces[row, :count], found.lie.forces[row, count + 1 :]
        most = int(np.argmax(np.abs(on_body))) if on_body.any() else None
        tilt = float(found.tilt[row])
        responses.append(
            SteadyResponse(
                rss_force=force,
                build_rate=float(found.curvature[row]),
                build_rate_error=nan,
                bit_tilt=tilt,
                bit_tilt_saturation=wall(tilt) if abs(tilt) >= case.bit.tilt_limit - CLOSE else 0,
                stabilizer_contact=tuple(map(wall, on_stabilizers.tolist())),
                stabilizer_force=tuple(on_stabilizers.tolist()),
                stabilizer_deflection=tuple(deflections[row].tolist()),
                body_contact_force=0.0 if most is None else float(on_body[most]),
                body_contact_position=0.0 if most is None else float(s[count + 1 + most]),
            )
        )
    return tuple(responses)


def build_rate_curve(case: Case, inclination: float, force_limit: float, *, gravity: bool = True) -> tuple[Piece, ...]:
    """The response to every force up to a limit to either side, as the straight pieces of its curve.

    Parameters
    ----------
    case, inclination, gravity
        As in `steady_response`.
    force_limit
        Largest force to either side, N, positive.

    Returns
    -------
    tuple of Piece
        By increasing force, from −`force_limit` to `force_limit`; each begins where the one before ends.

    Raises
    ------
    ParameterError
        If a value is not finite, or the limit is not positive.
    """
    check_number("force_limit", force_limit, above=0.0)
    steady, bha = _steady(case, inclination, gravity), case.bha
    limit = force_limit / bha.force_scale
    try:
        lines = list(steady.walk(-limit, limit))
    except RuntimeError as error:
        raise ParameterError("force_limit", f"must be smaller (--force-limit), since {error}", force_limit) from error
    pieces = []
    for line, start, end in lines:
        zero = 0.0 if line.regime.saturation else reversal(steady.scaled, line.mode)
        pieces.append(
            Piece(
                start=_in_si(bha, line, start * bha.force_scale),
                end=_in_si(bha, line, end * bha.force_scale),
                gain=line.rate[0] / (bha.length_scale * bha.force_scale),
                reversal_eta_pi=zero,
                reversal_weight=zero * case.active_weight_on_bit / steady.eta_pi,
            )
        )
    return tuple(pieces)


def largest_build_rate(
    case: Case, inclination: float, force_limit: float, *, gravity: bool = True
) -> tuple[SteadyResponse, SteadyResponse]:
    """The responses with the highest and with the lowest build rate under forces up to `force_limit` (N).

    They need not be at the limit: if the tilt is saturated, or above the ηΠ of the reversal, a larger push builds less.
    Parameters and errors are those of `build_rate_curve`.
    """
    curve = build_rate_curve(case, inclination, force_limit, gravity=gravity)
    kinks = [curve[0].start, *(piece.end for piece in curve)]
    return max(kinks, key=_build_rate), min(kinks, key=_build_rate)


def holding_forces(
    case: Case, inclination: float, force_limit: float, *, gravity: bool = True
) -> tuple[SteadyResponse, ...]:
    """The responses without curvature, under the forces that hold an inclination, the smallest force first.

    The tuple is empty if no force up to the limit holds it. Usually there is one force; there are more if the build
    rate does not always grow with the force. Parameters and errors are those of `build_rate_curve`.
    """
    curve = build_rate_curve(case, inclination, force_limit, gravity=gravity)
    builds = [curve[0].start.build_rate > 0, *(piece.end.build_rate > 0 for piece in curve)]
    forces = [
        piece.end.rss_force - piece.end.build_rate / piece.gain
        for piece, before, after in zip(curve, builds, builds[1:], strict=False)
        if before != after
    ]
    found = [steady_response(case, force, inclination, gravity=gravity) for force in forces]
    return tuple(sorted(found, key=lambda response: abs(response.rss_force)))


def _build_rate(response: SteadyResponse) -> float:
    return response.build_rate


def _steady(case: Case, inclination: float, gravity: bool) -> "Steady":
    check_quantity("inclination", inclination)
    scaled = scale(case.bha, case.bit)
    if not gravity:
        scaled = replace(scaled, w=0.0)
    return Steady(scaled, case.eta_pi, inclination)


def _in_si(bha: BottomHoleAssembly, line: "Line", rss_force: float) -> SteadyResponse:
    l1, F_star = bha.length_scale, bha.force_scale
    kappa, psi = line.at(rss_force / F_star)
    loads = line.loads(rss_force / F_star)
    F = [row(loads) for row in line.mode.F]
    contacts = zip(line.mode.contact, F, bha.stabilizer_clearances, strict=True)
    return SteadyResponse(
        rss_force=rss_force,
        build_rate=kappa / l1,
        build_rate_error=line.error_rate * kappa / l1,
        bit_tilt=psi,
        bit_tilt_saturation=line.regime.saturation,
        stabilizer_contact=tuple(contact if clearance else wall(f) for contact, f, clearance in contacts),
        stabilizer_force=tuple(f * F_star for f in F),
        stabilizer_deflection=tuple(row(loads) * l1 for row in line.mode.delta),
    )


# From here on quantities are dimensionless.


def moment(row: Row, s: tuple[float, ...], power: int) -> float:
    """Σ row_i s_i^power: the value of a row under the offsets e_i = s_i^power."""
    return dot(row.e, [s_i**power for s_i in s])


def reversal(scaled: Scaled, mode: Mode) -> float:
    """The ηΠ above which a push to the high side drops the hole while the tilt is not saturated; inf if there is none.

    It is the ηΠ at which dκ/dF_RSS is zero, and does not depend on the law of the bit.
    """
    M, F_0 = mode.M, mode.F_0
    if M.rss > -ROUNDING:  # the pads are at the bit, or at a stabilizer on a wall: their force does not turn the bit
        return inf
    return moment(M, scaled.s, 1) * F_0.rss / M.rss - moment(F_0, scaled.s, 1)


class Line:
    """κ and ψ as linear functions of F_RSS in one regime: a line in the diagram of either."""

    def __init__(self, steady: "Steady", regime: Regime) -> None:
        self.regime, self.mode, self.sine = regime, steady.modes[regime.contact], steady.sine
        self.s = s = steady.scaled.s
        M, F_0, saturation, epsilon_eta_pi = self.mode.M, self.mode.F_0, regime.saturation, steady.epsilon_eta_pi
        a, b = epsilon_eta_pi + moment(M, s, 2) / 2, moment(M, s, 1)
        c, d = (0.0, 1.0) if saturation else (moment(F_0, s, 2) / 2, steady.eta_pi + moment(F_0, s, 1))

        def solve(of_M: float, of_F_0: float, limit: float = 0.0) -> tuple[float, float]:
            """κ and ψ of the two equations with these right-hand sides; a saturated tilt is ψ = `limit` instead."""
            second = limit if saturation else of_F_0
            return (d * of_M - b * second) / (a * d - b * c), (a * second - c * of_M) / (a * d - b * c)

        self.rest = solve(
            M.g * self.sine + M.constant, F_0.g * self.sine + F_0.constant, saturation * steady.scaled.psi_star
        )
        self.rate = solve(M.rss, F_0.rss)
        # Along the arc κ and ψ change at the rates κ₁ κ and ψ₁ κ. This adds κ₁ κ s_i³/6 to e_i and ψ₁ κ to θ'.
        kappa_1, psi_1 = (steady.cosine * x for x in solve(M.g, F_0.g))
        self.error_rate, _ = solve(
            moment(M, s, 3) / 6 * kappa_1 - epsilon_eta_pi * psi_1, moment(F_0, s, 3) / 6 * kappa_1
        )

    def at(self, F_rss: float) -> tuple[float, float]:
        """κ and ψ under a force."""
        return self.rest[0] + self.rate[0] * F_rss, self.rest[1] + self.rate[1] * F_rss

    def loads(self, F_rss: float) -> Loads:
        """What bends the beam under a force."""
        return Loads(offsets(self.s, *self.at(F_rss)), F_rss, self.sine)

    def slope(self, row: Row) -> float:
        """The change of a row's value per force."""
        return dot(row.e, offsets(self.s, *self.rate)) + row.rss


def offsets(s: tuple[float, ...], kappa: float, psi: float) -> list[float]:
    """e_1 … e_n in a hole of curvature κ at bit tilt ψ."""
    return [-s_i * psi - s_i**2 * kappa / 2 for s_i in s]


class Steady:
    """The constant-curvature responses of a system at one ηΠ and inclination ⟨Θ⟩_1."""

    def __init__(self, scaled: Scaled, eta_pi: float, inclination: float) -> None:
        self.scaled, self.eta_pi, self.epsilon_eta_pi = scaled, eta_pi, scaled.epsilon * eta_pi
        self.sine, self.cosine = sin(inclination), cos(inclination)
        self.modes = Modes(scaled)

    def bounds(self, regime: Regime) -> list[Bound]:
        """The bounds within which a regime holds."""
        return regime.bounds(self.modes, self.eta_pi, self.scaled.psi_star)

    def line_at(self, F_rss: float) -> Line:
        """The line of the regime that holds under a force, found by pivoting from no contact and no saturation."""
        free = self.modes.free()
        regime = free.settle(lambda regime: (self.bounds(regime), Line(self, regime).loads(F_rss)))
        return Line(self, regime)

    def walk(self, start: float, stop: float) -> Iterator[tuple[Line, float, float]]:
        """The lines that hold from one force to a larger one, each with the two forces between which it holds.

        Raises `RuntimeError` if there are more than `MOST_PIECES`.
        """
        line, at = self.line_at(start), start
        for _ in range(MOST_PIECES):
            if at >= stop:
                return
            end, part, side = self._first_met(line, at)
            if min(end, stop) - at > ROUNDING:
                yield line, at, min(end, stop)
            line, at = Line(self, line.regime.switch(part, side)), end
        raise RuntimeError(f"up to it the curve has more than {MOST_PIECES} pieces")

    def _first_met(self, line: Line, at: float) -> tuple[float, int, int]:
        """The first force from `at` on at which a line meets a bound, the part that the bound is of, and its side."""
        loads = line.loads(at)
        met = (inf, 0, 0)
        for bound in self.bounds(line.regime):
            slope, value = bound.scale * line.slope(bound.row), bound.scale * bound.row(loads)
            side = 1 if slope > 0 else -1
            limit = bound.upper if slope > 0 else bound.lower
            if slope and abs(limit) < inf:
                met = min(met, (at + max((limit - value) / slope, 0.0), bound.part, side))
        return met
