"""The opponent: classical RK4 on a fixed grid, the model hard-coded for stabilizers at 1 and 2, in plain Python.

The step is 1/m, so delayed values at the ends of a step are grid values and those in its middle come from cubic Hermite
interpolation. Contact and saturation are clips. No events, no error control, F_RSS = 0.
"""

from itertools import pairwise
from math import sin
from typing import Any


def rk4(case: dict[str, Any], m: int) -> tuple[list[float], list[float]]:
    """θ and Y on the grid ξ = k/m, k = 0 … length·m, of one of the reference cases with two stabilizers."""
    w, eta_pi, epsilon = case["w"], case["eta_pi"], case["epsilon"]
    psi_star, y_star = case["psi_star"], case["y_star"][0]
    # section 3 of the model with s = (1, 2), λ = 2, written out
    stiffness = 32 / 7  # K_11
    g_delta, g_moment, g_force = -w / 4, w / 2, 5 / 4 * w
    rate = 1 / (epsilon * eta_pi)
    h = 1 / m
    survey: list[tuple[float, float]] = list(zip(case["survey_xi"], case["survey_inc"], strict=True))

    def inclination(xi: float) -> float:
        for (a, inc_a), (b, inc_b) in pairwise(survey):
            if xi <= b:
                return inc_a + (inc_b - inc_a) * (xi - a) / (b - a)
        return survey[-1][1]

    steps = round(case["length"] * m)
    theta = survey[-1][1]
    slope = [inclination(-2.0 + k * h) for k in range(2 * m + 1)]
    past = [0.0]
    for k in range(2 * m):
        past.append(past[-1] + h / 2 * (slope[k] + slope[k + 1]))
    past = [Y - past[-1] for Y in past]
    thetas = [theta]

    def f(theta: float, Y: float, Y1: float, Y2: float) -> tuple[float, float]:
        gravity = sin(Y - Y1)
        e2 = Y - Y2 - 2 * theta
        q = Y - Y1 - theta - 0.3125 * e2 + g_delta * gravity
        if q < -y_star:
            F = -stiffness * (q + y_star)
        elif q > y_star:
            F = -stiffness * (q - y_star)
        else:
            F = 0.0
        psi = (0.125 * e2 - 0.6875 * F + g_force * gravity) / eta_pi
        if psi > psi_star:
            psi = psi_star
        elif psi < -psi_star:
            psi = -psi_star
        return rate * (0.25 * e2 - 0.375 * F + g_moment * gravity), theta - psi

    Y = 0.0
    half, eighth, sixth = h / 2, h / 8, h / 6
    slope[-1] = f(theta, Y, past[m], past[0])[1]
    for k in range(steps):
        a1, b1, s_a1, s_b1 = past[k + m], past[k + m + 1], slope[k + m], slope[k + m + 1]
        a2, b2, s_a2, s_b2 = past[k], past[k + 1], slope[k], slope[k + 1]
        m1 = (a1 + b1) / 2 + eighth * (s_a1 - s_b1)
        m2 = (a2 + b2) / 2 + eighth * (s_a2 - s_b2)
        t1, d1 = f(theta, Y, a1, a2)
        t2, d2 = f(theta + half * t1, Y + half * d1, m1, m2)
        t3, d3 = f(theta + half * t2, Y + half * d2, m1, m2)
        t4, d4 = f(theta + h * t3, Y + h * d3, b1, b2)
        theta += sixth * (t1 + 2 * (t2 + t3) + t4)
        Y += sixth * (d1 + 2 * (d2 + d3) + d4)
        past.append(Y)
        slope.append(f(theta, Y, b1, b2)[1])
        thetas.append(theta)
    return thetas, past[2 * m :]


if __name__ == "__main__":
    import json
    from pathlib import Path

    cases = json.loads((Path(__file__).parents[1] / "tests" / "reference" / "cases.json").read_text(encoding="utf-8"))
    rk4(cases["fig7_psi_2deg"], 2000)
