"""The modes of a drilling system: which stabilizers can touch the wall together, and the mode in which a case drills.

Stability is a property of a mode. A stabilizer that touches the wall in no hole takes part in none.
"""

from collections.abc import Iterable
from itertools import chain, combinations, product
from math import radians, sin

import numpy as np

from ...case.case import Case
from ...core.modes import Loads, Modes
from ...core.system import BitRock, BottomHoleAssembly, scale
from ..steering import offsets, steady_response
from .roots import critical_of

SHARPEST_TURN = radians(10.0) / 30.0  # rad/m: steerable systems hardly turn a hole faster
TILTS = 21  # bit tilts that are tried, from one limit to the other; fewer might miss a contact of a short range
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
    """The contacts that occur in a hole that is straight, or turns by 10° over 30 m to either side.

    Parameters
    ----------
    bha, bit
        The drilling system. Bit tilts up to the limit to both sides are tried.
    inclination
        Inclination of the hole, rad.
    rss_forces
        Steering forces, N. No force is always tried.

    Returns
    -------
    frozenset of Contact
        The contacts that occur in any of these holes at any of these tilts under any of these forces.
    """
    scaled = scale(bha, bit)
    modes = Modes(scaled)
    turn = SHARPEST_TURN * bha.length_scale
    contact, met = (0,) * len(scaled.y_star), set()
    tilts = np.linspace(-bit.tilt_limit, bit.tilt_limit, TILTS).tolist()
    for force, kappa, psi in product({0.0, *rss_forces}, (-turn, 0.0, turn), tilts):
        loads = Loads(offsets(scaled.s, kappa, psi), force / bha.force_scale, sin(inclination))
        contact = modes.settle(loads, contact).contact
        met.add(tuple(i for i, touches in enumerate(contact, 1) if touches))
    return frozenset(met)


def can_touch(bha: BottomHoleAssembly, bit: BitRock, inclination: float, rss_forces: Iterable[float] = ()) -> Contact:
    """The stabilizers that touch in any of `contacts_met`: all whose clearance some hole uses up."""
    return tuple(sorted(set().union(*contacts_met(bha, bit, inclination, rss_forces))))


def first_that_touches(case: Case) -> int:
    """The number of the first stabilizer that `can_touch` under the case's forces; 1 if none can."""
    touching = can_touch(case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force)
    return touching[0] if touching else 1


def steady_mode(case: Case, rss_force: float, inclination: float) -> tuple[Contact, bool]:
    """The mode of the steady response to a force: that in which a case drills once transients have died out.

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
    bha: BottomHoleAssembly, bit: BitRock, inclination: float, rss_forces: Iterable[float] = (), first: Contact = ()
) -> tuple[Contact, ...]:
    """The sets of contacts that a chart shows, at most four, the largest sets first.

    These are all sets of the stabilizers that `can_touch`, if there are no more than four. Otherwise they are the set
    of all of them, the set `first` (that of the steady mode) and, of `contacts_met`, those that oscillate up to the
    largest ηΠ.
    """
    met = contacts_met(bha, bit, inclination, rss_forces)
    touching = set(first).union(*met)
    possible = all_contacts(bha, touching)
    if len(possible) <= MOST_SETS:
        return possible

    def rank(contact: Contact) -> tuple[bool, float]:
        critical = critical_of(bha, bit, contact, False, inclination)
        return contact in (first, possible[0]), critical.eta_pi if critical else 0.0

    chosen = sorted({*met, first, possible[0]}, key=rank, reverse=True)[:MOST_SETS]
    return tuple(contact for contact in possible if contact in chosen)


def numbers(bha: BottomHoleAssembly) -> range:
    """The numbers of the stabilizers that are not ideal: 1 … n − 1."""
    return range(1, len(bha.stabilizer_positions))


def always_touching(bha: BottomHoleAssembly) -> Contact:
    """The stabilizers without clearance."""
    return tuple(i for i, clearance in enumerate(bha.stabilizer_clearances, 1) if not clearance)
