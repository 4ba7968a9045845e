"""Drilling in space, by the kernel: the hole may leave its vertical plane."""

from collections.abc import Sequence
from typing import Unpack

import numpy as np

from ..core.errors import ParameterError
from ..core.ground import Ground
from ..core.inputs import Slopes
from ..core.options import Options
from ..core.quantities import TOOLFACE_REFERENCES
from ..core.survey import Survey
from ..core.system import BitRock, BottomHoleAssembly
from .binding import SPATIAL, NativeDrilling


class SpaceDrilling(NativeDrilling):
    """A borehole as it is drilled in space.

    Parameters, units, numbers and errors are those of `NativeDrilling`, and besides

    Parameters
    ----------
    azimuth
        Of the existing hole at each station, rad, from north over east. Where the inclination is zero it means nothing.
        Between stations the hole turns along the great circle, at a constant rate.
    rss_toolface
        Side to which the pads push, looking down the hole, rad: 0 up or north, π/2 to the right.
    toolface_reference
        One of `TOOLFACE_REFERENCES`. Against gravity or north the side is followed all the way.

    Raises
    ------
    ParameterError
        If a value is out of range, or the body of the BHA has points that may touch the wall.
    KernelError
        If the kernel cannot be used.
    """

    def __init__(
        self,
        bha: BottomHoleAssembly,
        bit: BitRock,
        survey: Survey,
        azimuth: Sequence[float] = (),
        *,
        active_weight_on_bit: float,
        rss_force: float = 0.0,
        rss_toolface: float = 0.0,
        toolface_reference: str = "gravity",
        weight_on_bit: float = 0.0,
        options: Options = Options(),  # noqa: B008 - frozen
        ground: Ground | None = None,
    ) -> None:
        stations = len(survey.measured_depth)
        if len(azimuth) not in (0, stations):
            raise ParameterError("azimuth", f"must hold {stations} values, one a station", len(azimuth))
        acting = {
            "rss_force": rss_force,
            "active_weight_on_bit": active_weight_on_bit,
            "weight_on_bit": weight_on_bit,
            "rss_toolface": rss_toolface,
            "toolface_reference": _reference(toolface_reference),
        }
        given = np.asarray(azimuth or np.zeros(stations), dtype=float)
        self._start(SPATIAL, bha.structure._replace(space=1), bha, bit, survey, given, acting, options, ground)

    def advance(
        self,
        drilled_length: float,
        rss_force: float,
        active_weight_on_bit: float,
        *,
        rss_toolface: float = 0.0,
        toolface_reference: str = "gravity",
        weight_on_bit: float = 0.0,
        bit: BitRock | None = None,
        **slopes: Unpack[Slopes],
    ) -> None:
        """Drill on under inputs from here, constant or linear in the drilled length; toolface and walk are constant."""
        forces = {
            "rss_force": rss_force,
            "active_weight_on_bit": active_weight_on_bit,
            "weight_on_bit": weight_on_bit,
            "rss_toolface": rss_toolface,
            "toolface_reference": _reference(toolface_reference),
        }
        self._advance(drilled_length, forces, bit, slopes)


def _reference(name: str) -> float:
    """The number that a toolface reference has in C."""
    if name not in TOOLFACE_REFERENCES:
        raise ParameterError("toolface_reference", f"must be {' or '.join(TOOLFACE_REFERENCES)}", name)
    return float(TOOLFACE_REFERENCES.index(name))
