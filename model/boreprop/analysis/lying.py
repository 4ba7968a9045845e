"""BHAs as they are built, in holes that are given: how they lie there, and the holes that they drill steadily.

Sections, an axial load and points of the body are the native engine's, and so are these answers: `kernel.binding.lie`
finds contacts, forces and shape from the offsets of the bit's axis from the hole, and everything here is a question put
to it. The questions of the paper's beam, which is linear within a regime, are in `steering` and `sag`.
"""

from typing import NamedTuple

import numpy as np

from ..arrays import Floats
from ..case.case import Case
from ..core.checks import check_quantity
from ..core.system import BottomHoleAssembly, check_in_plane
from ..kernel.binding import Lie, lie

MOST_STEPS = 60  # of Newton's method, which needs four to eight; a row that has not converged by then is bracketed
AGAIN = 10  # steps after which rows that go round in a circle start again, between those that have converged
CLOSE = 1e-9  # rad, in the tilt and in the turn over ℓ₁: far below what is shown
NUDGE = 1e-7  # rad, in the same, for the slopes of Newton's method, which are exact within a regime
PARTS = (1.0, 0.6, 0.3, 0.1, 0.03)  # of a step, of which the best is taken: a whole one may pass by several contacts
STEEPEST = 1.0  # rad over ℓ₁: the curvature is sought up to here, far beyond any hole


class SteadyLie(NamedTuple):
    """Holes of constant curvature, a row for each force: how they curve, and how the BHA lies in them."""

    curvature: Floats  # rad/m, (m,)
    tilt: Floats  # ψ, rad, (m,)
    lie: Lie  # with the shape at the stabilizers


def supports_of(bha: BottomHoleAssembly) -> Floats:
    """Distances from the bit of all that the wall may push, m: the n stabilizers, then the points of the body."""
    return np.array([*bha.stabilizer_positions, *bha.body_point_positions])


def pressing_weight(case: Case) -> float:
    """The weight on bit that presses the BHA of a case along its axis, N."""
    return (case.weight_on_bit or case.active_weight_on_bit) if case.bha.axial_load else 0.0


def steady_lie(case: Case, rss_force: Floats, inclination: float, *, gravity: bool = True) -> SteadyLie:
    """The holes of constant curvature that constant forces drill at an inclination, (14) and (17) with `lie`.

    In such a hole the offset of the bit's axis is e(s) = −s ψ − s² κ/2, the tilt is ψ = F_0/(ηΠ) up to its limit, and
    the moment turns the bit by M = εηΠ κ. A larger tilt lowers F_0, and a larger curvature lowers M, also with the tilt
    that belongs to it: so there is one answer to each force (shown for the paper's beam, see `steering`, and taken to
    hold well below buckling). Newton's method finds it within the contacts of one guess after another. A row in which
    it goes round in a circle starts again between the answers to other forces, and in the end is bracketed.

    Parameters
    ----------
    case
        What is drilled.
    rss_force
        Forces of the steering pads, N, (m,).
    inclination
        Of the hole, at which the weight acts, rad.
    gravity
        False leaves out the weight of the BHA across its axis.

    Raises
    ------
    ParameterError
        If the BHA buckles under the weight.
    CannotContinue
        If no contacts are found.
    KernelError
        If the native engine cannot be used.
    """
    steady = _Steady(case, inclination, gravity)
    found = np.zeros((rss_force.size, 2))  # ψ, and the turn of the hole over ℓ₁, κ ℓ₁
    missing, open_rows = steady.missing(found, rss_force), np.arange(rss_force.size)
    for count in range(MOST_STEPS):
        closed = np.abs(missing).max(axis=1) <= CLOSE
        open_rows = np.flatnonzero(~closed)
        if not open_rows.size:
            break
        if count and count % AGAIN == 0 and closed.any():
            found[open_rows] = _between(rss_force[open_rows], rss_force[closed], found[closed])
            missing[open_rows] = steady.missing(found[open_rows], rss_force[open_rows])
        at, forces = found[open_rows], rss_force[open_rows]
        found[open_rows], missing[open_rows] = steady.improved(at, missing[open_rows], forces)
    for row in open_rows:
        found[row] = steady.bracketed(float(rss_force[row]))
    return SteadyLie(found[:, 1] / case.length_scale, found[:, 0], steady.lie(found, rss_force))


def _between(rss_force: Floats, known_force: Floats, known: Floats) -> Floats:
    """Answers to some forces, between those that are known, (m, 2)."""
    order = np.argsort(known_force)
    return np.column_stack([np.interp(rss_force, known_force[order], column[order]) for column in known.T])


class _Steady:
    """What is missing of the balance of a bit at some tilt in a hole of some curvature."""

    def __init__(self, case: Case, inclination: float, gravity: bool) -> None:
        check_quantity("inclination", inclination)
        self.case, self.inclination, self.weight = case, inclination, float(gravity)
        self.s, self.pressing = supports_of(case.bha), pressing_weight(case)
        check_in_plane(case.bit)
        self.limit = case.bit.tilt_limit
        self.per_tilt = case.bit.lateral_steering_resistance * case.active_weight_on_bit  # N: ηΠ
        self.per_turn = case.bit.angular_steering_resistance * case.active_weight_on_bit * case.length_scale  # N·m: εηΠ

    def lie(self, at: Floats, rss_force: Floats) -> Lie:
        """How the BHA lies with ψ and κ ℓ₁, (m, 2)."""
        psi, turn = at.T[..., None]
        own = psi[:, 0] if self.case.bha.axial_load else 0.0  # of the bit, else of the hole behind it
        return lie(
            self.case.bha,
            -self.s * psi - self.s**2 * turn / (2 * self.case.length_scale),
            rss_force,
            self.weight * np.sin(np.full(len(at), self.inclination) + own),
            weight_on_bit=self.pressing,
            inclination=self.inclination,
            places=self.case.bha.stabilizer_positions,
        )

    def missing(self, at: Floats, rss_force: Floats) -> Floats:
        """What the tilt and the turn that follow from the forces have more than those that are tried, rad, (m, 2)."""
        found = self.lie(at, rss_force)
        tilt = np.clip(found.bit_force / self.per_tilt, -self.limit, self.limit)
        return np.column_stack((tilt, found.bit_moment / self.per_turn)) - at

    def improved(self, at: Floats, missing: Floats, rss_force: Floats) -> tuple[Floats, Floats]:
        """ψ and κ ℓ₁ after the part of a step of Newton's method that leaves least missing, and what is missing."""
        nudged = np.concatenate([at + NUDGE * unit for unit in np.eye(2)])
        beyond = self.missing(nudged, np.tile(rss_force, 2)).reshape(2, *at.shape)
        slopes = np.moveaxis((beyond - missing) / NUDGE, 0, -1)
        step = np.linalg.solve(slopes, missing[..., None])[..., 0]
        tried = at - np.multiply.outer(PARTS, step)
        left = self.missing(tried.reshape(-1, 2), np.tile(rss_force, len(PARTS))).reshape(tried.shape)
        best = np.abs(left).max(axis=2).argmin(axis=0)
        rows = np.arange(len(at))
        return tried[best, rows], left[best, rows]

    def bracketed(self, rss_force: float) -> tuple[float, float]:
        """ψ and κ ℓ₁ under one force by bisection in bisection."""
        from scipy.optimize import brentq  # imported here, since the viewer, which draws with this module, does without

        force = np.array([rss_force])

        def missing(tilt: float, turn: float) -> Floats:
            row: Floats = self.missing(np.array([[tilt, turn]]), force)[0]
            return row

        def tilt_at(turn: float) -> float:
            low, high = missing(-self.limit, turn)[0], missing(self.limit, turn)[0]
            if low <= 0.0 or high >= 0.0:
                return -self.limit if low <= 0.0 else self.limit
            return float(brentq(lambda tilt: missing(tilt, turn)[0], -self.limit, self.limit, xtol=CLOSE))

        turn = float(brentq(lambda turn: missing(tilt_at(turn), turn)[1], -STEEPEST, STEEPEST, xtol=CLOSE))
        return tilt_at(turn), turn
