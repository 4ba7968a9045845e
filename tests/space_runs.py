"""Runs in space, in the paper's numbers: with ℓ₁ = 1 m and EI = 1/3 N m² they are the SI units of the engine."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import accumulate
from math import atan2, cos, hypot, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from boreprop.core.options import Options
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.space import SpaceDrilling
from reference.spatial import CASES

Vector = NDArray[np.float64]
Outputs = dict[str, float | int]

IN_SECTIONS = BottomHoleAssembly(
    (3.0, 8.0, 17.0),
    (2e-3, 3e-3),
    0.6,
    1500.0,
    1e7,
    section_lengths=(4.0, 13.0),
    section_distributed_weights=(1500.0, 900.0),
    section_flexural_stiffnesses=(1e7, 4e6),
    section_outer_diameters=(0.0, 0.0),
    end_deflection=-4e-3,
    axial_load=True,
)


@dataclass(frozen=True)
class SpatialCase:
    """A drilling system and what it drills from and under, in the paper's numbers."""

    s: tuple[float, ...] = (1.0, 2.0)
    y_star: tuple[float, ...] = (1e-3,)
    Delta: float = 0.16
    w: float = 2.4513948e-3
    eta_pi: float = 0.01
    epsilon: float = 0.1
    psi_star: float = 0.034906585
    walk: float = 0.0
    stations: tuple[float, ...] = (-2.0, -1.0, 0.0)
    inclination: tuple[float, ...] = (0.0, 0.0, 0.0087)
    azimuth: tuple[float, ...] = (0.0, 0.0, 0.0)
    force: float = 0.0
    toolface: float = 0.0
    reference: str = "gravity"
    sensors: tuple[float, ...] = ()

    def begin(self, **options: float) -> SpaceDrilling:
        """The run before its first step."""
        return SpaceDrilling(
            BottomHoleAssembly(self.s, self.y_star, self.Delta, self.w, 1 / 3, sensor_positions=self.sensors),
            BitRock(1.0, self.epsilon, self.psi_star, self.walk),
            Survey(tuple(xi - self.stations[0] for xi in self.stations), self.inclination),
            self.azimuth,
            active_weight_on_bit=self.eta_pi,
            rss_force=self.force,
            rss_toolface=self.toolface,
            toolface_reference=self.reference,
            options=Options(**options),  # type: ignore[arg-type]
        )

    def advance(self, run: SpaceDrilling, xi: float, **changes: Any) -> None:
        """Drill on under the inputs of the case."""
        aim: dict[str, Any] = {"rss_toolface": self.toolface, "toolface_reference": self.reference, **changes}
        run.advance(xi, self.force, self.eta_pi, **aim)

    def rows(self, places: Vector | list[float], **options: float) -> list[Outputs]:
        """The outputs at places."""
        run, found = self.begin(**options), []
        for xi in places:
            self.advance(run, float(xi))
            found.append(run.outputs())
        return found


TURNING = SpatialCase(
    s=(1.0, 1.8, 3.1),
    y_star=(8e-4, 1.5e-3),
    eta_pi=0.15,
    walk=0.2,
    stations=(-3.2, -1.0, -0.4, 0.0),
    inclination=(0.5, 0.5, 0.505, 0.51),
    azimuth=(1.0, 1.0, 1.02, 1.02),
    force=5e-3,
    toolface=0.8,
)
"""A hole that turns and walks, with all stabilizers between the walls and on them."""


def referred(name: str) -> SpatialCase:
    """A case of tests/reference_spatial under its first force, which is held in the frame of the bit."""
    p = CASES[name]
    high, right = p["force"]["bit_frame_force"][0]
    return SpatialCase(
        s=tuple(accumulate(p["lambda"])),
        y_star=tuple(p["y_star"]),
        Delta=p["delta"],
        w=p["w"],
        eta_pi=p["eta_pi"],
        epsilon=p["epsilon"],
        psi_star=p["psi_star"],
        walk=p["walk"],
        stations=tuple(p["hole"]["xi"]),
        inclination=tuple(p["hole"]["inclination"]),
        azimuth=tuple(p["hole"]["azimuth"]),
        force=hypot(high, right),
        toolface=atan2(right, high),
        reference="frame",
    )


def rows_of(name: str, places: Vector, **options: float) -> Iterator[Outputs]:
    """The outputs of a case of tests/reference_spatial at places, under all its forces."""
    case, force = referred(name), CASES[name]["force"]
    run, coming = case.begin(**options), list(zip(force["xi"], force["bit_frame_force"], strict=True))[1:]
    for xi in places:
        while coming and coming[0][0] <= xi:
            place, (high, right) = coming.pop(0)
            case.advance(run, place)
            case = replace(case, force=hypot(high, right), toolface=atan2(right, high))
        case.advance(run, float(xi))
        yield run.outputs()


def direction(row: Outputs, what: str) -> Vector:
    """The axis of the "bit" or of the "borehole", north, east and down."""
    inclination, azimuth = row[f"{what}_inclination"], row[f"{what}_azimuth"]
    return np.array([sin(inclination) * cos(azimuth), sin(inclination) * sin(azimuth), cos(inclination)])


def place(row: Outputs) -> Vector:
    """Where the bit is, north, east and down."""
    return np.array([row["north"], row["east"], row["true_vertical_depth"]])


def pair(row: Outputs, name: str, i: int = 0) -> Vector:
    """The parts of a vector to the high side and to the right, of the stabilizer `i` if it has a number."""
    number = f"[{i}]" if i else ""
    return np.array([row[f"{name}_high{number}"], row[f"{name}_right{number}"]])
