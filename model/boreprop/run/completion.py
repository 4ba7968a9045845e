"""Computes the columns that a run lacks from those that it has.

A file of another tool may hold few columns, and the viewer draws many. There are three tables of formulas. Those of
`ROW_BY_ROW` and `OF_THE_BEAM` are exact, so the result of one may enter another; the latter are those of the paper's
beam, and left out for any other. Those of `ALONG_THE_HOLE` integrate or difference over
the rows, so their error depends on the spacing of the rows. Their results enter no other formula: an error of 0.01° in
⟨Θ⟩_i would be tens of newtons at the bit.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from math import floor, log10
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..case.case import Case
from ..core.beam import Beam
from ..core.modes import Loads, Modes
from ..core.quantities import BY_NAME, CLEARANCES
from ..core.system import Scaled, scale
from ..errors import InputError
from .ground import blunt_weight, on_rows
from .trajectory import Trajectory

Array = NDArray[np.float64]

IN_SPACE = ("eta_pi", "active_weight_on_bit", "stabilizer_contact", "rate_of_penetration")
"""What the formulas also give of a run in space; the others are those of the plane."""
INDISPENSABLE = ("bit_inclination", "average_inclination", "stabilizer_force")  # the BHA cannot be drawn without them
FORCE_ROUNDING = 1e-9  # F*, some millinewtons: far above the rounding errors of a balance in a file of twelve digits
RATE_DECIMALS = 7  # of a rate in m/s: the further ones are rounding errors of lengths and times
AT_LIMIT = 1e-4  # ψ*: a tilt this close to its limit counts as at it, so that files of six digits serve


def complete(run: Trajectory) -> Trajectory:
    """Add the columns that a run lacks and that its other columns and its case determine.

    Parameters
    ----------
    run
        The run, with its case and drilled_length, which must not decrease.

    Returns
    -------
    Trajectory
        The columns of `run` as they are, then the new ones. A column that nothing determines stays missing.

    Raises
    ------
    InputError
        If the run lacks its case, drilled_length, or one of the `INDISPENSABLE` that nothing determines.
    """
    columns = Columns(run, case_of(run))
    columns.add_row_by_row()
    columns.add_along_the_hole()
    completed = replace(run, columns=columns.by_name)
    for name in INDISPENSABLE:
        completed.stack(name)  # raises if it is missing
    return completed


def complete_rows(rows: Trajectory) -> Trajectory:
    """Add the columns that some rows of a run lack and that each row alone determines.

    Parameters
    ----------
    rows
        Any rows of a run, with its case and drilled_length.

    Returns
    -------
    Trajectory
        The columns of `rows` as they are, then the new ones.

    Raises
    ------
    InputError
        If the run lacks its case or drilled_length.
    """
    columns = Columns(rows, case_of(rows))
    columns.add_row_by_row()
    return replace(rows, columns=columns.by_name)


def case_of(run: Trajectory) -> Case:
    """The case of a run; `InputError` if it has none."""
    if run.case is None:
        raise InputError("the run must come with its case, got none: give it with --case or --fmu")
    return run.case


class Columns:
    """The columns of a run by name of quantity, to which formulas add more.

    The values of a quantity have the shape (rows,), those of a quantity of each stabilizer (rows, n) or (rows, n − 1).
    """

    def __init__(self, run: Trajectory, case: Case) -> None:
        self.by_name, self.row_count, self.case = dict(run), run.row_count, case
        self.length, self.force = case.bha.length_scale, case.bha.force_scale  # ℓ₁, F*

    @cached_property
    def scaled(self) -> Scaled:
        """The paper's numbers of the drilling system; `ParameterError` if its beam is not the paper's."""
        return scale(self.case.bha, self.case.bit)

    @cached_property
    def beam(self) -> Beam:
        """The paper's beam."""
        return Beam(self.scaled)

    def __contains__(self, name: str) -> bool:
        return all(scalar in self.by_name for scalar in self._scalars(name))

    def __getitem__(self, name: str) -> Array:
        values = [self.by_name[scalar] for scalar in self._scalars(name)]
        if name == "time" or BY_NAME[name].size == "1":
            return values[0]
        return np.column_stack(values) if values else np.empty((self.row_count, 0))

    def _scalars(self, name: str) -> list[str]:
        return [name] if name == "time" else BY_NAME[name].names(len(self.case.bha.stabilizer_positions))

    def on_rows(self, name: str) -> Array:
        """η, χ, ψ* or a clearance at each row."""
        return on_rows(self.case, self.by_name, name)

    def add(self, formulas: "tuple[Formula, ...]") -> bool:
        """Add every missing quantity for which a formula has all that it needs. Returns whether any was added."""
        before = len(self.by_name)
        for formula in formulas:
            if formula.gives not in self and all(name in self for name in formula.needs):
                values = formula.values(self)
                if values is not None:
                    for scalar, column in zip(self._scalars(formula.gives), np.atleast_2d(values.T), strict=True):
                        self.by_name.setdefault(scalar, column)
        return len(self.by_name) > before

    def add_row_by_row(self) -> None:
        """Add all that the formulas of `ROW_BY_ROW` give, one from another."""
        if self.case.in_space:
            rows = tuple(formula for formula in ROW_BY_ROW if formula.gives in IN_SPACE)
        else:
            rows = ROW_BY_ROW + (OF_THE_BEAM if self.case.bha.structure.is_of_the_paper else ())
        while self.add(rows):
            pass

    def add_along_the_hole(self) -> None:
        """Add what the formulas of `ALONG_THE_HOLE` give."""
        in_space = self.case.in_space
        self.add(tuple(formula for formula in ALONG_THE_HOLE if not in_space or formula.gives in IN_SPACE))


class Formula(NamedTuple):
    """How a quantity follows from others; `values` returns None where the values of a run do not determine it."""

    gives: str
    needs: tuple[str, ...]
    values: Callable[[Columns], Array | None]


# Row by row. The core's formulas for the beam are plain arithmetic, so they also work on columns.


def eta_pi(columns: Columns) -> Array:
    """ηΠ = η (Π F*)/F*, (3) and (9), of the rock of the row and with what wear leaves of the weight."""
    sharp = columns["active_weight_on_bit"] - blunt_weight(columns.case, columns["drilled_length"])
    return columns.on_rows("lateral_steering_resistance") * sharp / columns.force


def active_weight_on_bit(columns: Columns) -> Array:
    """Π F*, (3) and (9), as of a sharp bit."""
    active = columns["eta_pi"] * columns.force / columns.on_rows("lateral_steering_resistance")
    return active + blunt_weight(columns.case, columns["drilled_length"])


def bit_inclination(columns: Columns) -> Array:
    """θ = Θ + ψ, (16)."""
    return columns["borehole_inclination"] + columns["bit_tilt"]


def borehole_inclination(columns: Columns) -> Array:
    """Θ = θ − ψ, (16)."""
    return columns["bit_inclination"] - columns["bit_tilt"]


def bit_tilt(columns: Columns) -> Array:
    """ψ = θ − Θ, (16)."""
    return columns["bit_inclination"] - columns["borehole_inclination"]


def bit_tilt_from_force(columns: Columns) -> Array:
    """ψ = clip(F_0/(ηΠ), −ψ*, ψ*), (10) and (11)."""
    psi_star = columns.on_rows("bit_tilt_limit")
    return np.clip(columns["bit_lateral_force"] / columns.force / columns["eta_pi"], -psi_star, psi_star)


def bit_tilt_saturation(columns: Columns) -> Array:
    """1 where ψ is at +ψ*, −1 where it is at −ψ*, 0 in between, (11)."""
    psi = columns["bit_tilt"]
    return np.where(np.abs(psi) >= (1 - AT_LIMIT) * columns.on_rows("bit_tilt_limit"), np.sign(psi), 0.0)


class LoadColumns(NamedTuple):
    """`Loads` of all rows, each field a column: what bends the BHA besides the contact forces."""

    e: list[Any]
    F_rss: Any
    sin_Theta_1: Any


def loads(columns: Columns, rss_force: Any) -> LoadColumns:
    """e_i = Σ_{k≤i} λ_k (⟨Θ⟩_k − θ), F_RSS and sin⟨Θ⟩_1, dimensionless."""
    averages = columns["average_inclination"]
    turns = (averages - columns["bit_inclination"][:, None]) * columns.scaled.lambda_
    return LoadColumns(list(np.cumsum(turns, axis=1).T), rss_force / columns.force, np.sin(averages[:, 0]))


def contacts(columns: Columns) -> Any:
    """F_1 … F_{n−1}, dimensionless, a column for each."""
    return list(columns["stabilizer_force"].T / columns.force)


def bit_lateral_force(columns: Columns, rss_force: Any) -> Any:
    """F_0 under an RSS force, (14)."""
    at = loads(columns, rss_force)
    return columns.force * columns.beam.bit_force(at.e[-1], contacts(columns), at.F_rss, at.sin_Theta_1)


def bit_moment(columns: Columns, rss_force: Any) -> Any:
    """M_0 = −M under an RSS force, (17)."""
    at = loads(columns, rss_force)
    M = columns.beam.bit_moment(at.e[-1], contacts(columns), at.F_rss, at.sin_Theta_1)
    return -columns.force * columns.length * M


def rss_force_from_force(columns: Columns) -> Array | None:
    """F_RSS from the lateral force on the bit, (14)."""
    rest = columns["bit_lateral_force"] - bit_lateral_force(columns, 0.0)
    return rounded_force(columns, rest, columns.beam.F0_rss)


def rss_force_from_moment(columns: Columns) -> Array | None:
    """F_RSS from the moment on the bit, (17)."""
    rest = columns["bit_moment"] - bit_moment(columns, 0.0)
    return rounded_force(columns, rest, -columns.length * columns.beam.M_rss)


def rounded_force(columns: Columns, rest: Array, per_force: float) -> Array | None:
    """The RSS force that accounts for the rest of a balance, without its rounding errors.

    None where the pads push at a support, which bears their force: then the balance does not depend on it.
    """
    if per_force == 0.0:
        return None
    decimals = -floor(log10(FORCE_ROUNDING * columns.force))
    return np.round(rest / per_force, decimals)


def stabilizer_force(columns: Columns) -> Array:
    """F_i from the contact conditions (7) and the deflections (21)."""
    bending, scaled = loads(columns, columns["rss_force"]), columns.scaled
    made: dict[tuple[float, ...], Modes] = {}  # by the clearances
    contact = (0,) * len(scaled.y_star)
    y_star = [columns.on_rows(name) / columns.length for name in CLEARANCES[: len(contact)]]
    values = np.empty((columns.row_count, len(contact)))
    for k, (*e, F_rss, sine) in enumerate(np.column_stack((*bending.e, bending.F_rss, bending.sin_Theta_1)).tolist()):
        at, own = Loads(e, F_rss, sine), tuple(float(column[k]) for column in y_star)
        if own not in made:
            made[own] = Modes(replace(scaled, y_star=own))
        mode = made[own].settle(at, contact)
        contact, values[k] = mode.contact, [row(at) for row in mode.F]
    return columns.force * values


def stabilizer_deflection(columns: Columns) -> Array:
    """δ = q̃ + K⁻¹F, (21)."""
    at = loads(columns, columns["rss_force"])
    q_tilde = columns.beam.q_tilde(at.e, at.F_rss, at.sin_Theta_1)
    delta: Array = np.column_stack(q_tilde) + columns["stabilizer_force"] / columns.force @ np.array(columns.beam.K_inv)
    return columns.length * delta


# Along the hole: the stations of the existing hole, then one for each row; the inclination is linear in between.


class Stations:
    """Stations of the existing and the drilled hole. Where the inclination jumps, two stations have the same length.

    Attributes
    ----------
    length
        Length of each station from the start of the run, m, negative in the existing hole, shape (N,).
    inclination
        Inclination of the hole at each station, rad, shape (N,).
    start
        Index of the station at which the bit starts the run; the rows follow it.
    """

    def __init__(self, columns: Columns) -> None:
        survey = columns.case.survey
        existing = np.array(survey.measured_depth) - survey.measured_depth[-1]
        above = existing[0] - columns.case.bha.stabilizer_positions[-1]  # straight above the first station
        self.length = np.concatenate(([above], existing, columns["drilled_length"]))
        self.inclination = np.concatenate(
            (survey.inclination[:1], survey.inclination, columns["borehole_inclination"]), dtype=np.float64
        )
        self.start = existing.size

    def inclination_at(self, length: Array) -> Array:
        """Θ at given lengths; where it jumps, after the jump."""
        return np.interp(length, self.length, self.inclination)

    def lateral_at(self, length: Array) -> Array:
        """Y = ∫ Θ ds at given lengths."""
        pieces = np.diff(self.length) * (self.inclination[1:] + self.inclination[:-1]) / 2
        station = np.searchsorted(self.length, length, side="right") - 1
        mean = (self.inclination[station] + self.inclination_at(length)) / 2
        return np.append(0.0, np.cumsum(pieces))[station] + (length - self.length[station]) * mean


def axis_of(length: Array, inclination: Array) -> Array:
    """The axis of a hole: positions (x, z) of its stations, m, shape (N, 2), the first one at the origin.

    Between stations the inclination, shape (N,), is linear in the length, shape (N,). So each piece of the hole is an
    arc of a circle, and the positions are exact.
    """
    mean = (inclination[1:] + inclination[:-1]) / 2
    chord = np.diff(length) * np.sinc(np.diff(inclination) / (2 * np.pi))
    pieces = chord[:, None] * np.column_stack((np.sin(mean), np.cos(mean)))
    return np.concatenate((np.zeros((1, 2)), np.cumsum(pieces, axis=0)))


def drilled(columns: Columns) -> Array:
    """Positions (x, z) of the bit, (rows, 2), from where the run starts."""
    at = Stations(columns)
    return axis_of(at.length[at.start :], at.inclination[at.start :])[1:]


def average_inclination(columns: Columns) -> Array:
    """⟨Θ⟩_i = (Y(ξ−s_{i−1}) − Y(ξ−s_i))/λ_i, (6)."""
    behind = np.append(0.0, columns.case.bha.stabilizer_positions)
    lateral = Stations(columns).lateral_at(columns["drilled_length"][:, None] - behind)
    return -np.diff(lateral, axis=1) / np.diff(behind)


def borehole_curvature(columns: Columns) -> Array:
    """Change of Θ over the last ℓ₁, divided by ℓ₁."""
    behind = Stations(columns).inclination_at(columns["drilled_length"] - columns.length)
    return (columns["borehole_inclination"] - behind) / columns.length


def rate_of_penetration(columns: Columns) -> Array | None:
    """Drilled length per time from each row to the next; None if no time passes in the whole run.

    A row at which the time stands still, and the last row, have the rate of a neighbour.
    """
    time = np.diff(columns["time"])
    pieces = np.flatnonzero(time > 0.0)
    if not pieces.size:
        return None
    rates = np.round(np.diff(columns["drilled_length"])[pieces] / time[pieces], RATE_DECIMALS)
    piece = np.searchsorted(pieces, np.arange(columns.row_count))
    return rates[np.minimum(piece, pieces.size - 1)]


ANGLES = ("bit_inclination", "average_inclination")  # these and the RSS force make up the `loads`
BENDING = (*ANGLES, "stabilizer_force")  # these and the RSS force are all that bends the BHA

ROW_BY_ROW = (
    Formula("eta_pi", ("active_weight_on_bit",), eta_pi),
    Formula("active_weight_on_bit", ("eta_pi",), active_weight_on_bit),
    Formula("bit_inclination", ("borehole_inclination", "bit_tilt"), bit_inclination),
    Formula("borehole_inclination", ("bit_inclination", "bit_tilt"), borehole_inclination),
    Formula("bit_tilt", ("bit_inclination", "borehole_inclination"), bit_tilt),
    Formula("bit_tilt", ("bit_lateral_force", "eta_pi"), bit_tilt_from_force),
    Formula("bit_tilt_saturation", ("bit_tilt",), bit_tilt_saturation),
    Formula("stabilizer_contact", ("stabilizer_force",), lambda k: np.sign(k["stabilizer_force"])),  # (7)
)

OF_THE_BEAM = (
    Formula("rss_force", (*BENDING, "bit_lateral_force"), rss_force_from_force),
    Formula("rss_force", (*BENDING, "bit_moment"), rss_force_from_moment),
    Formula("stabilizer_force", (*ANGLES, "rss_force"), stabilizer_force),
    Formula("stabilizer_deflection", (*BENDING, "rss_force"), stabilizer_deflection),
    Formula("bit_lateral_force", (*BENDING, "rss_force"), lambda k: bit_lateral_force(k, k["rss_force"])),
    Formula("bit_moment", (*BENDING, "rss_force"), lambda k: bit_moment(k, k["rss_force"])),
)

ALONG_THE_HOLE = (
    Formula("average_inclination", ("borehole_inclination",), average_inclination),
    Formula("borehole_curvature", ("borehole_inclination",), borehole_curvature),
    Formula("displacement", ("borehole_inclination",), lambda k: drilled(k)[:, 0]),
    Formula("true_vertical_depth", ("borehole_inclination",), lambda k: drilled(k)[:, 1]),
    Formula("rate_of_penetration", ("time",), rate_of_penetration),
)
