"""The characteristic function of one mode of a straight hole, section V, and where its roots cross the imaginary axis.

In a mode (which stabilizers touch, tilt saturated or not) a small perturbation of a straight hole of inclination Θ₀
is a sum of terms e^{νξ}. With Θ ~ e^{νξ} the lateral coordinate gives Y(ξ) − Y(ξ−s_i) = B_i(ν) Θ with
B_i = (1 − e^{−ν s_i})/ν, and sin⟨Θ⟩_1 becomes cos Θ₀ B_1 Θ, so

    M = m_θ θ + m(ν) Θ ,   F_0 = f_θ θ + f(ν) Θ ,   m = Σ m_i B_i ,   f = Σ f_i B_i ,

and ν is a root of

    unsaturated:   P = (εηΠν − m_θ)(ηΠ + f) − (ηΠ − f_θ) m
    saturated:     P = εηΠν − m_θ − m .

B_i is entire: that the hole may be moved sideways makes no root.
"""

from cmath import sqrt
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.assembly import Scaled
from ..core.beam import Beam
from ..core.contact import Mode
from ..core.linear import dot

NEAR_ZERO = 1e-4  # |ν s| below which B'(ν) is the start of its series
FREQUENCIES = np.concatenate([[0.0], np.logspace(-3.0, 9.0, 300)])  # where bounds on the roots are looked for
ABSCISSAS = np.linspace(0.0, 5.0, 101) ** 2
SAMPLES = 12  # per period of the fastest wave in the equation for the crossings
LOW = np.array([0.01, 0.1, 0.5])  # further samples below the first, in steps
REFINEMENTS = 5  # of a crossing found between two samples: ηΠ is then good to 1e-9 or better

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


class Crossings(NamedTuple):
    """Where P(iω) = 0 with ω > 0: arrays of one length, ηΠ increasing."""

    eta_pi: Floats
    omega: Floats
    direction: Floats  # 1 where the pair moves into the right half plane as ηΠ grows, −1 where out of it


@dataclass(frozen=True)
class Characteristic:
    """The characteristic function P of one mode, over arrays of ν of any shape."""

    s: Floats  # s_1 … s_n
    m: Floats  # m_1 … m_n, the first with m_g
    f: Floats  # f_1 … f_n, the first with f_g
    m_g: float  # the weight's part
    f_g: float
    m_theta: float
    f_theta: float
    epsilon: float
    saturated: bool

    @classmethod
    def of(
        cls, scaled: Scaled, contact: tuple[int, ...], saturated: bool, inclination: float = 0.0
    ) -> "Characteristic":
        """Of the mode with `contact` (0 where a stabilizer is free) in a straight hole of `inclination`, rad."""
        mode = Mode(Beam(scaled), scaled.y_star, contact)
        s = list(scaled.s)
        weight = round(cos(inclination), 15)  # none in a horizontal hole
        m_g, f_g = mode.M.g * weight, mode.F_0.g * weight
        return cls(
            s=np.array(s),
            m=np.array([mode.M.e[0] + m_g, *mode.M.e[1:]]),
            f=np.array([mode.F_0.e[0] + f_g, *mode.F_0.e[1:]]),
            m_g=m_g,
            f_g=f_g,
            m_theta=-dot(mode.M.e, s),
            f_theta=-dot(mode.F_0.e, s),
            epsilon=scaled.epsilon,
            saturated=saturated,
        )

    def __call__(self, nu: Complexes, eta_pi: float) -> tuple[Complexes, Complexes]:
        """P(ν) and P'(ν)."""
        m, f, m_slope, f_slope = np.zeros((4, *nu.shape), complex)
        for s_i, m_i, f_i in self._terms.tolist():
            B, slope = lag(nu, s_i)
            m += m_i * B
            f += f_i * B
            m_slope += m_i * slope
            f_slope += f_i * slope
        drag, rest = self.epsilon * eta_pi, eta_pi - self.f_theta
        turning = drag * nu - self.m_theta
        if self.saturated:
            return turning - m, drag - m_slope
        return turning * (eta_pi + f) - rest * m, drag * (eta_pi + f) + turning * f_slope - rest * m_slope

    @cached_property
    def _terms(self) -> Floats:
        """s_i, m_i, f_i of the stabilizers that matter in this mode, a row for each."""
        terms = np.column_stack([self.s, self.m, self.f])
        return terms[terms[:, 1:].any(axis=1)]

    def on_grid(self, x: Floats, y: Floats, eta_pi: float) -> Complexes:
        """νP at ν = x + iy, shape (len(y), len(x)): cheap, as e^{−ν s} is a product."""
        nu = x + 1j * y[:, None]
        wave, decay = np.exp(-1j * y[:, None] * self.s), np.exp(-self.s[:, None] * x)
        m: Complexes = self.m.sum() - (wave * self.m) @ decay
        f: Complexes = self.f.sum() - (wave * self.f) @ decay
        turning = self.epsilon * eta_pi * nu - self.m_theta
        if self.saturated:
            return turning * nu - m
        return turning * (eta_pi * nu + f) - (eta_pi - self.f_theta) * m

    def at_zero(self) -> tuple[float, float]:
        """P(0) = b ηΠ + c: b and c, both zero without weight and in a horizontal hole, where turning is neutral."""
        if self.saturated:
            return 0.0, -self.m_g
        return -self.m_g, self.f_theta * self.m_g - self.m_theta * self.f_g

    def on_real_axis(self, nu: Floats) -> tuple[Floats, Floats, Floats]:
        """P = a ηΠ² + b ηΠ + c at real ν > 0: a, b and c."""
        m, f = np.zeros((2, *nu.shape))
        for s_i, m_i, f_i in self._terms.tolist():
            B = -np.expm1(-nu * s_i) / nu
            m += m_i * B
            f += f_i * B
        drag = self.epsilon * nu
        if self.saturated:
            return np.zeros_like(nu), drag, -self.m_theta - m
        return drag, drag * f - self.m_theta - m, self.f_theta * m - self.m_theta * f

    def on_imaginary_axis(
        self, omega: Floats, waves: tuple[Floats, Floats] | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """The equation for roots at ν = iω, ω > 0: its value, the ηΠ of a root where it is zero, and a sign.

        The square of ηΠ has an imaginary factor, so the real part of P is linear in ηΠ. With that ηΠ put in, the
        imaginary part is the equation for ω; saturated, the real part itself is. As ηΠ grows, the root moves right
        where the slope of the equation has the sign that is returned. `waves` are sin ωs and cos ωs, if known.
        """
        s, rows = self._terms[:, :1], self._terms[:, 1:].T
        sine, cosine = waves or (np.sin(s * omega), np.cos(s * omega))
        m_re, f_re = rows @ sine / omega
        m_im, f_im = rows @ (cosine - 1) / omega
        drag = self.epsilon * omega
        if self.saturated:
            return -self.m_theta - m_re, m_im / drag, np.ones_like(omega)
        b_re, b_im = -drag * f_im - self.m_theta - m_re, drag * f_re - m_im
        c_re, c_im = self.f_theta * m_re - self.m_theta * f_re, self.f_theta * m_im - self.m_theta * f_im
        with np.errstate(divide="ignore"):
            return drag * c_re**2 - b_im * b_re * c_re + c_im * b_re**2, -c_re / b_re, -np.sign(b_re)

    def crossings(self, smallest: float) -> Crossings:
        """All crossings of the imaginary axis at ηΠ >= `smallest`, but for those at ω = 0."""
        step, number = self.sampling(smallest)
        even = step * np.arange(1.0, number + 1)
        parts = [
            self.on_imaginary_axis(step * LOW),
            self.on_imaginary_axis(even, even_waves(step * self._terms[:, :1], number)),
        ]
        omega = np.concatenate([step * LOW, even])
        value, eta_pi, sign = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        at = np.flatnonzero((value[1:] > 0) != (value[:-1] > 0))
        at = at[np.maximum(eta_pi[at], eta_pi[at + 1]) > smallest / 2]
        # at a pole of ηΠ the value is positive: then the zero is on the side of negative ηΠ if the other end is, too
        larger = np.where(eta_pi[at] > eta_pi[at + 1], at, at + 1)
        at = at[(sign[at] == sign[at + 1]) | (value[larger] < 0)]
        direction = np.sign(value[at + 1] - value[at])
        omega = zero(lambda omega: self.on_imaginary_axis(omega)[0], omega[at], omega[at + 1], value[at], value[at + 1])
        _, eta_pi, sign = self.on_imaginary_axis(omega)
        wanted = eta_pi >= smallest
        order = np.argsort(eta_pi[wanted])
        return Crossings(*(column[wanted][order] for column in (eta_pi, omega, direction * sign)))

    def sampling(self, smallest: float) -> tuple[float, int]:
        """Spacing and number of ω at which `on_imaginary_axis` tells all about roots with ηΠ >= `smallest`."""
        step = 2 * pi / (3 * float(self.s[-1])) / SAMPLES
        return step, int(self.highest(smallest, 0.0) / step) + 2

    def highest(self, eta_pi: float, abscissa: float) -> float:
        """A bound on |Im ν| of the roots with Re ν >= `abscissa`."""
        zeros = [zero for zero in self._free_roots(eta_pi) if zero.real >= abscissa]
        without = self._delayed_share(abscissa + 1j * FREQUENCIES, eta_pi) < 1
        without &= max((zero.imag for zero in zeros), default=0.0) < FREQUENCIES
        return float(FREQUENCIES[np.flatnonzero(~without)[-1] + 1])

    def rightmost(self, eta_pi: float) -> float:
        """A bound on Re ν of the roots."""
        without = self._delayed_share(ABSCISSAS[:, None] + 1j * FREQUENCIES, eta_pi).max(axis=1) < 1
        without &= max(zero.real for zero in self._free_roots(eta_pi)) < ABSCISSAS
        return float(ABSCISSAS[np.flatnonzero(~without)[-1] + 1])

    # νP = Q_0 + Σ Q_i e^{−ν s_i} with polynomials Q, so there is no root where Σ |Q_i e^{−ν s_i}| < |Q_0|. The ratio of
    # the two has no maximum within a region that holds no zero of Q_0: what it is on the edge decides.

    def _free(self, eta_pi: float) -> tuple[float, float, float]:
        """The coefficients of the quadratic Q_0."""
        drag, m, f = self.epsilon * eta_pi, float(self.m.sum()), float(self.f.sum())
        if self.saturated:
            return drag, -self.m_theta, -m
        return drag * eta_pi, drag * f - self.m_theta * eta_pi, -self.m_theta * f - (eta_pi - self.f_theta) * m

    def _free_roots(self, eta_pi: float) -> tuple[complex, complex]:
        """The zeros of Q_0."""
        a, b, c = self._free(eta_pi)
        root = sqrt(b * b - 4 * a * c)
        return (-b + root) / (2 * a), (-b - root) / (2 * a)

    def _delayed_share(self, nu: Complexes, eta_pi: float) -> Floats:
        """Σ |Q_i e^{−ν s_i}| / |Q_0|."""
        turning = 0.0 if self.saturated else self.epsilon * eta_pi * nu - self.m_theta
        rest = 1.0 if self.saturated else eta_pi - self.f_theta
        delayed = np.zeros(nu.shape)
        for s_i, m_i, f_i in self._terms.tolist():
            delayed += abs(rest * m_i - turning * f_i) * np.exp(-nu.real * s_i)
        a, b, c = self._free(eta_pi)
        share: Floats = delayed / abs((a * nu + b) * nu + c)
        return share


def even_waves(turn: Floats, number: int) -> tuple[Floats, Floats]:
    """Sine and cosine of kx for k = 1 … number and x in `turn`, shape (rows, 1): cheap, as e^{ikx} is a product."""
    short = int(number**0.5) + 1
    fine, coarse = np.exp(1j * turn * np.arange(1, short + 1)), np.exp(1j * turn * short * np.arange(short))
    product = (coarse[:, :, None] * fine[:, None, :]).reshape(len(turn), -1)[:, :number]
    return product.imag.copy(), product.real.copy()


def lag(nu: Complexes, s: float) -> tuple[Complexes, Complexes]:
    """B(ν) = (1 − e^{−νs})/ν and its slope."""
    safe = np.where(abs(nu) < NEAR_ZERO, NEAR_ZERO, nu)
    less = -np.expm1(-safe * s)
    B, decay = less / safe, 1 - less
    near = -nu * s
    return (
        np.where(safe == nu, B, s * (1 + near / 2 * (1 + near / 3 * (1 + near / 4)))),
        np.where(safe == nu, (s * decay - B) / safe, -(s**2) * (1 / 2 + near / 3 * (1 + near * 3 / 8))),
    )


def zero(function: Callable[[Floats], Floats], a: Floats, b: Floats, f_a: Floats, f_b: Floats) -> Floats:
    """Zeros of `function` between a and b, where it has the values f_a and f_b of different sign.

    Regula falsi with the weights of Anderson and Björck.
    """
    c = b
    with np.errstate(divide="ignore", invalid="ignore"):  # where f_b is zero to the last bit
        for _ in range(REFINEMENTS if len(b) else 0):
            c = np.where(f_b == 0, b, (a * f_b - b * f_a) / (f_b - f_a))
            f_c = function(c)
            stays = (f_c > 0) == (f_b > 0)
            weight = 1 - f_c / f_b
            f_a = np.where(stays, f_a * np.where(weight > 0, weight, 0.5), f_b)
            a = np.where(stays, a, b)
            b, f_b = c, f_c
    return c
