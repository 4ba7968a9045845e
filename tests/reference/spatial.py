"""The model in space as a short program: a fixed-step method of steps, written from the equations, not from the engine.

It is slow and says nothing of events; with it the engine's law in space is checked. Everything is dimensionless, as in
docs/model.md: lengths over ℓ₁, forces over F*, angles in rad. Vectors of the world are (north, east, down). Vectors
across the bit have two components, to e₂ and to e₃, in the frame Q = [e₂ e₃ d] that is carried along with the axis d of
the bit without twist:

    d′ = e₂ θ₂′ + e₃ θ₃′ ,   e₂′ = −d θ₂′ ,   e₃′ = −d θ₃′

The equations, with e_i = Y(ξ) − Y(ξ−s_i) − s_i θ, and T the direction of the hole at the bit:

    εηΠ θ′ = M ,   Y′ = Θ = θ − ψ ,   R′ = T

The unknowns θ, Y, Q, R are integrated by the classical Runge–Kutta method of order 4 with a fixed step; the delayed Y
come from its cubic Hermite interpolation. So the order is 4 if all delays and all places where an input changes are
multiples of the step. Contacts and the limit of the tilt make kinks in between, each with a small error of order 2.
"""

import gzip
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate
from math import asin, ceil, cos, hypot, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

FOLDER = Path(__file__).parents[1] / "reference_spatial"
CASES: dict[str, dict[str, Any]] = json.loads((FOLDER / "cases.json").read_text(encoding="utf-8"))["cases"]
REFERENCES = {"gravity": (0.0, 0.0, -1.0), "north": (1.0, 0.0, 0.0)}  # what a toolface is measured from
CONVERGED = 3e-15  # change of the contact forces in a sweep over all of them, over the largest
SWEEPS = 1000


@dataclass(frozen=True)
class Push:
    """The force of the pads from ξ on, at a toolface γ from the high side ("gravity"), "north", or e₂ ("frame")."""

    xi: float
    force: float
    toolface: float = 0.0
    reference: str = "gravity"
    follows: bool = False  # the toolface is held against its reference; without it, the force is held in (e₂, e₃)


@dataclass(frozen=True)
class System:
    """A drilling system, its existing hole, and the forces of the pads."""

    s: tuple[float, ...]  # s_1 = 1 … s_n
    y_star: tuple[float, ...]  # y*_1 … y*_{n−1}
    Delta: float
    w: float
    eta_pi: float
    epsilon: float
    psi_star: float
    walk: float  # ϖ
    stations: Vector  # ξ <= 0 of the stations of the existing hole, the last at 0
    directions: Vector  # Θ there, shape (k, 2), linear in between, in the chart of the frame at the start
    frame: Vector  # Q at the start
    pushes: tuple[Push, ...] = (Push(0.0, 0.0, reference="frame"),)  # none


@dataclass(frozen=True)
class Row:
    """What is true at the bit."""

    xi: float
    theta: Vector
    Theta: Vector
    psi: Vector
    d: Vector  # the bit's axis
    T: Vector  # the direction of the hole
    R: Vector  # where the bit is
    F: Vector  # the forces of the walls on the BHA, shape (n − 1, 2)
    F_0: Vector
    frame: Vector


class Beam:
    """The coefficients of M, F_0 and δ, those of the planar beam."""

    def __init__(self, system: System) -> None:
        s, L, w = np.array(system.s[:-1]), system.s[-1], system.w
        self.K_inv = np.array([[flexibility(a, b, L) for b in s] for a in s]).reshape(len(s), len(s))
        self.delta_e = s**2 * (s - 3 * L) / (2 * L**3)
        self.delta_rss = np.array([flexibility(a, system.Delta, L) for a in s])
        self.delta_g = w / 16 * s**2 * (2 * s - 3 * L) * (L - s)
        self.M_e, self.M_g, self.F0_e, self.F0_g = 1 / L**2, w * L**2 / 8, 1 / L**3, 5 / 8 * w * L
        at = np.append(s, system.Delta)
        moment, reaction = at * (at - L) * (2 * L - at) / (2 * L**2), -(2 * L**3 - 3 * L * at**2 + at**3) / (2 * L**3)
        self.M_F, self.M_rss, self.F0_F, self.F0_rss = moment[:-1], moment[-1], reaction[:-1], reaction[-1]


def flexibility(s: float, p: float, L: float) -> float:
    """Deflection at s under a unit force at p, (20)."""
    s, p = max(s, p), min(s, p)
    return p**2 / (4 * L**3) * (2 * L**3 * (3 * s - p) + (p - 3 * L) * s**2 * (3 * L - s))


def turned(angle: float) -> Vector:
    """R₂, the rotation across the bit that takes e₂ to e₃ by an angle."""
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def tilted(a: Vector) -> Vector:
    """R(a), the rotation by |a| that takes d to (sin|a| a/|a|, cos|a|) in the frame (e₂, e₃, d)."""
    angle = hypot(*a)
    sine, versine = (sin(angle) / angle, 2 * (sin(angle / 2) / angle) ** 2) if angle else (1.0, 0.5)
    x, y = a
    return np.array(
        [
            [1 - versine * x * x, -versine * x * y, sine * x],
            [-versine * x * y, 1 - versine * y * y, sine * y],
            [-sine * x, -sine * y, cos(angle)],
        ]
    )


def contact_forces(K_inv: Vector, q: Vector, y_star: Sequence[float], start: Vector) -> Vector:
    """The F that minimises ½Fᵀ(K⁻¹⊗I₂)F + q·F + Σ y*_i|F_i|, so that |δ_i| <= y*_i and F_i pushes inwards.

    In turn each F_i is the best for the others, in closed form. Such sweeps converge from anywhere; Newton's method on
    the stabilizers in contact makes it fast.
    """
    F = start
    for _ in range(SWEEPS):
        swept = sweep(K_inv, q, y_star, F)
        change = abs(swept - F).max(initial=0.0)
        if change <= CONVERGED * abs(swept).max(initial=0.0) or len(y_star) == 1:
            return swept
        F, better = swept, on_walls(K_inv, q, y_star, swept)
        if abs(sweep(K_inv, q, y_star, better) - better).max() < change / 2:
            F = better
    raise ArithmeticError("the contact forces do not converge")


def sweep(K_inv: Vector, q: Vector, y_star: Sequence[float], start: Vector) -> Vector:
    """Make each F_i in turn the best for the others; for one stabilizer that is the solution."""
    F = start.copy()
    for i, y in enumerate(y_star):
        rest = q[i] + K_inv[i] @ F - K_inv[i, i] * F[i]
        size = hypot(*rest)
        F[i] = -max(1 - y / size, 0.0) / K_inv[i, i] * rest if size else 0.0
    return F


def on_walls(K_inv: Vector, q: Vector, y_star: Sequence[float], F: Vector) -> Vector:
    """A step of Newton's method on δ_i + y*_i F_i/|F_i| = 0 of the stabilizers that touch."""
    size = np.hypot(*F.T)
    touching = np.flatnonzero(size)
    K, count = K_inv[np.ix_(touching, touching)], len(touching)
    n, softness = F[touching] / size[touching, None], np.array(y_star)[touching] / size[touching]
    residual = q[touching] + K @ F[touching] + np.array(y_star)[touching, None] * n
    across = softness[:, None, None] * (np.eye(2) - n[:, :, None] * n[:, None, :])
    slope = np.kron(K, np.eye(2)).reshape(count, 2, count, 2)
    slope[range(count), :, range(count), :] += across
    step = np.linalg.solve(slope.reshape(2 * count, 2 * count), residual.ravel())
    better = F.copy()
    better[touching] -= step.reshape(count, 2)
    return better


def bit_tilt(F_0: Vector, eta_pi: float, psi_star: float, walk: float) -> Vector:
    """ψ: F_0 − ηΠ R₂(ϖ)ψ points out of the disc |ψ| <= ψ* where |ψ| = ψ*, and is zero within it."""
    size = hypot(*F_0)
    if size <= eta_pi * psi_star:
        psi: Vector = turned(-walk) @ F_0 / eta_pi
    else:
        psi = psi_star * turned(-asin(eta_pi * psi_star * sin(walk) / size)) @ F_0 / size
    return psi


def push_vector(push: Push, frame: Vector) -> Vector:
    """The force of the pads in (e₂, e₃)."""
    high = np.array([1.0, 0.0]) if push.reference == "frame" else np.array(REFERENCES[push.reference]) @ frame[:, :2]
    across = np.array([-high[1], high[0]])
    force: Vector = push.force / hypot(*high) * (cos(push.toolface) * high + sin(push.toolface) * across)
    return force


def hole_before(system: System) -> Callable[[float], Vector]:
    """Y at ξ <= 0: the integral of Θ, which is linear between stations and constant above the first."""
    xi, Theta = system.stations, system.directions
    Y = np.zeros_like(Theta)
    for k in range(len(xi) - 2, -1, -1):
        Y[k] = Y[k + 1] - (xi[k + 1] - xi[k]) * (Theta[k] + Theta[k + 1]) / 2

    def at(place: float) -> Vector:
        k = max(min(int(np.searchsorted(xi, place, side="right")) - 1, len(xi) - 2), 0)
        on, length = place - xi[k], xi[k + 1] - xi[k]
        bend = on**2 / (2 * length) * (Theta[k + 1] - Theta[k]) if on > 0 else 0.0
        value: Vector = Y[k] + on * Theta[k] + bend
        return value

    return at


class Drilling:
    """A run with a fixed step, from ξ = 0 on."""

    def __init__(self, system: System, step: float) -> None:
        self.system, self.step, self.beam = system, step, Beam(system)
        self.before, self.s = hole_before(system), np.array(system.s)
        self.theta, self.Y, self.R = system.directions[-1].copy(), np.zeros(2), np.zeros(3)
        self.frame, self.F = system.frame.copy(), np.zeros((len(system.y_star), 2))
        self.count = 0  # steps taken
        self.knots: list[
            tuple[Vector, Vector, Vector]
        ] = []  # Y, and Y′ on the left and on the right, at each step's end
        self._take(system.pushes[0])
        first = self.row().Theta
        self.knots.append((self.Y, first, first))

    def _take(self, push: Push) -> None:
        """Let the pads push otherwise from here on."""
        self.push, self.held = push, push_vector(push, self.frame)

    def delayed(self, xi: float) -> Vector:
        """Y(ξ − s_i), shape (n, 2)."""
        return np.array([self._look_up(xi - s) for s in self.system.s])

    def _look_up(self, place: float) -> Vector:
        if place <= 0:
            return self.before(place)
        k = min(int(place / self.step), len(self.knots) - 2)
        u = place / self.step - k
        (Y, _, rate), (Y_next, rate_next, _) = self.knots[k], self.knots[k + 1]
        rise, bend = Y_next - Y, self.step * (rate + rate_next)
        value: Vector = Y + u * (self.step * rate + u * (3 * rise - bend - self.step * rate + u * (bend - 2 * rise)))
        return value

    def at(self, theta: Vector, Y: Vector, frame: Vector, delayed: Vector) -> tuple[Vector, Vector, Vector, Vector]:
        """M, F_0, ψ and F of a state."""
        system, beam = self.system, self.beam
        e = Y - delayed - self.s[:, None] * theta
        G = -(frame @ tilted(e[0]))[2, :2]
        pads = push_vector(self.push, frame) if self.push.follows else self.held
        q = e[:-1] + np.outer(beam.delta_e, e[-1]) + np.outer(beam.delta_rss, pads) + np.outer(beam.delta_g, G)
        F = contact_forces(beam.K_inv, q, system.y_star, self.F)
        M = beam.M_e * e[-1] + beam.M_F @ F + beam.M_rss * pads + beam.M_g * G
        F_0 = beam.F0_e * e[-1] + beam.F0_F @ F + beam.F0_rss * pads + beam.F0_g * G
        self.F = F
        return M, F_0, bit_tilt(F_0, system.eta_pi, system.psi_star, system.walk), F

    def row(self) -> Row:
        """What is true where the bit is."""
        xi, frame = self.count * self.step, self.frame
        _, F_0, psi, F = self.at(self.theta, self.Y, frame, self.delayed(xi))
        T = (frame @ tilted(-psi))[:, 2]
        return Row(xi, self.theta, self.theta - psi, psi, frame[:, 2], T, self.R, F, F_0, frame)

    def take_step(self) -> None:
        """One step of the classical Runge–Kutta method; then the next push, if there is one."""
        h, xi, system = self.step, self.count * self.step, self.system
        start = (self.theta, self.Y, self.frame, self.R)
        middle = self.delayed(xi + h / 2)
        rates: list[tuple[Vector, ...]] = []
        for c, delayed in ((0.0, self.delayed(xi)), (0.5, middle), (0.5, middle), (1.0, self.delayed(xi + h))):
            theta, Y, frame, _ = (y + c * h * rate for y, rate in zip(start, rates[-1], strict=True)) if c else start
            M, _, psi, _ = self.at(theta, Y, frame, delayed)
            turn = M / (system.epsilon * system.eta_pi)
            across = np.column_stack([-np.outer(frame[:, 2], turn), frame[:, :2] @ turn])
            rates.append((turn, theta - psi, across, (frame @ tilted(-psi))[:, 2]))
        self.theta, self.Y, self.frame, self.R = (
            y + h / 6 * (a + 2 * b + 2 * c + d) for y, a, b, c, d in zip(start, *rates, strict=True)
        )
        self.count += 1
        left = right = self.row().Theta
        for push in system.pushes:
            if self.count == round(push.xi / h):
                self._take(push)
                right = self.row().Theta
        self.knots.append((self.Y, left, right))


def drill(system: System, length: float, step: float, every: int = 1) -> list[Row]:
    """The rows of a run, one every so many steps, the first at ξ = 0."""
    drilling = Drilling(system, step)
    rows = [drilling.row()]
    for number in range(1, ceil(round(length / step, 6)) + 1):
        drilling.take_step()
        if number % every == 0:
            rows.append(drilling.row())
    return rows


def system_of(name: str) -> System:
    """A case of tests/reference_spatial: there the force is held in (e₂, e₃) from entry to entry."""
    p = CASES[name]
    hole, force = p["hole"], p["force"]
    references = [{"magnetic": "north"}.get(reference, reference) for reference in force["reference"]]
    return System(
        s=tuple(accumulate(p["lambda"])),
        y_star=tuple(p["y_star"]),
        Delta=p["delta"],
        w=p["w"],
        eta_pi=p["eta_pi"],
        epsilon=p["epsilon"],
        psi_star=p["psi_star"],
        walk=p["walk"],
        stations=np.array(hole["xi"]),
        directions=np.array(hole["developed"]),
        frame=np.array(hole["Q0"]),
        pushes=tuple(map(Push, force["xi"], force["force"], force["toolface"], references)),
    )


def read_reference(name: str) -> NDArray[Any]:
    """The rows of a reference, by column."""
    with gzip.open(FOLDER / CASES[name]["file"], "rt", encoding="utf-8") as file:
        return np.genfromtxt(file, delimiter=",", names=True)
