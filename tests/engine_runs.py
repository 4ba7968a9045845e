"""Runs of either engine in units where ℓ₁ = 1 m and F* = 1 N: lengths are ξ, forces F_RSS and the weight is ηΠ."""

from collections.abc import Iterator

import numpy as np

from boreprop.core.modes import Loads
from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly, Scaled
from boreprop.run.engines import DRILLING, Engine, held
from reference_cases import CASES, reference, reference_system

VERTICAL = Survey((0.0,), (0.0,))


def begin(engine: str, scaled: Scaled, survey: Survey, F_rss: float, eta_pi: float, **options: float) -> Engine:
    """The engine of this name at the end of a survey in units of ℓ₁."""
    s, intervals, biases, noises, seeds, clearances = zip(*scaled.sensors, strict=True) if scaled.sensors else ((),) * 6
    return DRILLING[engine](
        BottomHoleAssembly(
            scaled.s,
            scaled.y_star,
            scaled.Delta,
            scaled.w,
            1 / 3,
            sensor_positions=s,
            sensor_intervals=intervals,
            sensor_biases=biases,
            sensor_noises=noises,
            sensor_seeds=seeds,
            sensor_body_clearances=clearances,
        ),
        BitRock(1.0, scaled.epsilon, scaled.psi_star),
        survey,
        active_weight_on_bit=eta_pi,
        rss_force=F_rss,
        options=Options(**options),  # type: ignore[arg-type]
    )


def start(engine: str, name: str, **options: float) -> Engine:
    """The engine of this name at the start of a reference case."""
    scaled, survey = reference_system(name)
    return begin(engine, scaled, survey, CASES[name]["force_values"][0], CASES[name]["eta_pi"], **options)


def rows_along(
    run: Engine, ends: list[float], forces: list[float], eta_pi: float, rows: list[int]
) -> dict[str, np.ndarray]:
    """Drill leg after leg; the outputs at the ends that are rows, by column."""
    names = list(run.outputs())
    table = np.full((max(rows) + 1, len(names)), np.nan)
    inputs = held(len(ends), np.array(forces), eta_pi, run.bit)
    run.follow(np.array(ends), inputs, np.array(rows, dtype=np.intc), table)
    return dict(zip(names, table.T, strict=True))


def columns(run: Engine, xis: np.ndarray, F_rss: float, eta_pi: float) -> dict[str, np.ndarray]:
    """The outputs at increasing positions, by column."""
    return rows_along(run, xis.tolist(), [F_rss] * len(xis), eta_pi, list(range(len(xis))))


def legs_of(name: str) -> Iterator[tuple[float, float, int]]:
    """The legs of a reference case: where each ends, the force along it, the row there after a change (−1: none)."""
    changes = list(zip(CASES[name]["force_breaks"], CASES[name]["force_values"], strict=True))
    force = changes.pop(0)[1]
    for row, xi in enumerate(reference(name)["xi"].tolist()):
        while changes and changes[0][0] <= xi:
            yield changes[0][0], force, -1
            force = changes.pop(0)[1]
        yield xi, force, row


def drilled_rows(engine: str, name: str, **options: float) -> dict[str, np.ndarray]:
    """What the engine of this name drills of a reference case, at the rows of the reference."""
    ends, forces, rows = (list(values) for values in zip(*legs_of(name), strict=True))
    return rows_along(start(engine, name, **options), ends, forces, CASES[name]["eta_pi"], rows)


def step_ends(run: Engine, to: float) -> list[float]:
    """Where the integrator's own steps end."""
    ends = []
    while run.drilled_length < to:
        run.step()
        ends.append(run.drilled_length)
    return ends


def loads_of(scaled: Scaled, outputs: dict[str, float | int], F_rss: float) -> Loads:
    """What bends the beam, from the inclinations among the outputs: e_i = Σ_{k≤i} λ_k (⟨Θ⟩_k − θ)."""
    averages = [outputs[f"average_inclination[{i}]"] for i in range(1, len(scaled.s) + 1)]
    turns = np.array(scaled.lambda_) * (np.array(averages) - outputs["bit_inclination"])
    return Loads(np.cumsum(turns).tolist(), F_rss, float(np.sin(averages[0])))
