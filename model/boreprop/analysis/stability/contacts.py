"""The modes of a drilling system: which stabilizers can touch the wall together, and the mode in which a case drills.

Stability is a property of a mode. A stabilizer that touches the wall in no hole takes part in none.
"""

from collections.abc import Callable, Iterable
from functools import partial
from itertools import chain, combinations, product
from math import radians, sin

import numpy as np

from ...case.case import Case
from ...core.modes import Bound, Loads, Modes, Row
from ...core.system import BitRock, BottomHoleAssembly, scale
from ..steering import offsets, steady_response
from .roots import critical_of

SHARPEST_TURN = radians(10.0) / 30.0  # rad/m: steerable systems hardly turn a hole faster
FORCES = 7  # steering forces that are tried, from the smallest to the largest; more would take too long for a command
MOST_SETS = 4  # sets of contacts in a chart, each with the tilt saturated and not: eight panels

Contact = tuple[int, ...]
"""The numbers of the stabilizers that touch, increasing."""


def all_contacts(bha: BottomHoleAssembly, among: Iterable[int] | None = None) -> tuple[Contact, ...]:
    """All sets that the stabilizers numbered in `among` (None: all non-ideal ones) can form, the largest sets first.

    Stabilizers without clearance are in every set.
    """
    always = always_touching(bha)
    free = [i for i in numbers(bha) if i not in always and (among is None or i in among)]
    sets = chain.from_iterable(combinations(free, k) for k in range(len(free), -1, -1))
    return tuple(tuple(sorted((*always, *chosen))) for chosen in sets)


def contacts_met(
    bha: BottomHoleAssembly, bit: BitRock, inclination: float, rss_forces: Iterable[float] = ()
) -> frozenset[Contact]:
    """The contacts that occur in holes of constant curvature that turn by up to 10° over 30 m to either side.

    Contacts on given walls hold where forces and deflections are within their bounds, (7). Under a given force these
    are linear in curvature and tilt, so that is a convex polygon, which may be empty.

    Parameters
    ----------
    bha, bit
        The drilling system. The bit tilt is anywhere between its limits.
    inclination
        Inclination of the hole, rad.
    rss_forces
        Steering forces, N. They stand for all from the smallest to the largest, and for no force, of which some are
        tried.

    Returns
    -------
    frozenset of Contact
        The contacts that occur in any of these holes at any of these tilts under any of the forces tried. Of a beam
        that is not the paper's that is not computed: there it is all sets.
    """
    if not bha.structure.is_of_the_paper:
        return frozenset(all_contacts(bha))
    scaled = scale(bha, bit)
    modes, sine = Modes(scaled), sin(inclination)
    turn, tilt = SHARPEST_TURN * bha.length_scale, bit.tilt_limit
    everywhere = [complex(kappa, psi) for kappa, psi in ((-turn, -tilt), (turn, -tilt), (turn, tilt), (-turn, tilt))]
    wanted = {0.0, *rss_forces}
    forces = {0.0, *np.linspace(min(wanted), max(wanted), FORCES).tolist()}
    met: set[Contact] = set()
    for walls in product(*((0, 1, -1) if clearance else (1,) for clearance in scaled.y_star)):
        contact = tuple(i for i, touches in enumerate(walls, 1) if touches)
        for force in forces if contact not in met else ():
            where = everywhere
            for bound in modes[walls].bounds:
                where = _clipped(where, partial(_value, bound.row, scaled.s, force / bha.force_scale, sine), bound)
            if where:
                met.add(contact)
    return frozenset(met)


def _value(row: Row, s: tuple[float, ...], F_rss: float, sine: float, at: complex) -> float:
    """The value of a row in a hole of curvature Re `at` at a bit tilt of Im `at`."""
    return row(Loads(offsets(s, at.real, at.imag), F_rss, sine))


def _clipped(corners: list[complex], value: Callable[[complex], float], bound: Bound) -> list[complex]:
    """The corners of that part of a convex polygon in which a linear value is within a bound (Sutherland–Hodgman)."""
    for side, limit in ((1, bound.lower), (-1, -bound.upper)):
        inside = [side * bound.scale * value(corner) - limit for corner in corners]
        kept = []
        for k, corner in enumerate(corners):
            before, here = inside[k - 1], inside[k]
            if (before >= 0) != (here >= 0):
                kept.append(corners[k - 1] + (corner - corners[k - 1]) * before / (before - here))
            if here >= 0:
                kept.append(corner)
        corners = kept
    return corners


def can_touch(bha: BottomHoleAssembly, bit: BitRock, inclination: float, rss_forces: Iterable[float] = ()) -> Contact:
    """The stabilizers that touch in any of `contacts_met`: all whose clearance some hole uses up."""
    return tuple(sorted(set().union(*contacts_met(bha, bit, inclination, rss_forces))))


def first_that_touches(case: Case) -> int:
    """The number of the first stabilizer that `can_touch` under the case's forces; 1 if none can."""
    touching = can_touch(case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force)
    return touching[0] if touching else 1


def steady_mode(case: Case, rss_force: float, inclination: float) -> tuple[Contact, bool]:
    """The mode of the steady response to a force: that in which a case drills once transients die out.

    Parameters
    ----------
    case, rss_force, inclination
        As in `steering.steady_response`, whose errors it raises.

    Returns
    -------
    Contact, bool
        The stabilizers that touch, and whether the bit tilt is saturated.
    """
    response = steady_response(case, rss_force, inclination)
    touching = {i for i, wall in enumerate(response.stabilizer_contact, 1) if wall}
    return tuple(sorted(touching | set(always_touching(case.bha)))), bool(response.bit_tilt_saturation)


def charted(
    bha: BottomHoleAssembly,
    bit: BitRock,
    inclination: float,
    rss_forces: Iterable[float] = (),
    first: Contact = (),
    weight_on_bit: float = 0.0,
) -> tuple[Contact, ...]:
    """The sets of contacts that a chart shows, at most four, the largest sets first.

    These are all sets of the stabilizers that `can_touch`, if there are no more than four. Otherwise they are the set
    of all of them, the set `first` (that of the steady mode) and, of `contacts_met`, those that oscillate up to the
    largest ηΠ, under an axial load that of the weight on bit.
    """
    met = contacts_met(bha, bit, inclination, rss_forces)
    touching = set(first).union(*met)
    possible = all_contacts(bha, touching)
    if len(possible) <= MOST_SETS:
        return possible

    def rank(contact: Contact) -> tuple[bool, float]:
        critical = critical_of(bha, bit, contact, False, inclination, weight_on_bit)
        return contact in (first, possible[0]), critical.eta_pi if critical else 0.0

    chosen = sorted({*met, first, possible[0]}, key=rank, reverse=True)[:MOST_SETS]
    return tuple(contact for contact in possible if contact in chosen)


def numbers(bha: BottomHoleAssembly) -> range:
    """The numbers of the stabilizers that are not ideal: 1 … n − 1."""
    return range(1, len(bha.stabilizer_positions))


def always_touching(bha: BottomHoleAssembly) -> Contact:
    """The stabilizers without clearance."""
    return tuple(i for i, clearance in enumerate(bha.stabilizer_clearances, 1) if not clearance)
