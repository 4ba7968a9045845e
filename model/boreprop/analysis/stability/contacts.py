"""The modes that a drilling system can be in: which stabilizers touch the wall together, and the one it drills in.

Stability is a matter of one mode. A blade that no hole brings to the wall has no part in it.
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
TILTS = 21  # of the bit, from one limit to the other
MOST_SETS = 4  # in a chart, each with the tilt saturated and not

Contact = tuple[int, ...]
"""The numbers of the stabilizers that touch, increasing."""


def all_contacts(bha: BottomHoleAssembly, among: Iterable[int] | None = None) -> tuple[Contact, ...]:
    """The contacts that stabilizers with `among` these numbers can make (without it all), most stabilizers first.

    Those without clearance are in each.
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
        The drilling system. The bit tilts as far as its limit to both sides.
    inclination
        Of the hole, rad.
    rss_forces
        N; and without a force.

    Returns
    -------
    frozenset of Contact
        The contacts met in one of these holes at one of these tilts under one of these forces.
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
    """The stabilizers that touch in one of `contacts_met`: all but those whose clearance no hole uses up."""
    return tuple(sorted(set().union(*contacts_met(bha, bit, inclination, rss_forces))))


def first_that_touches(case: Case) -> int:
    """The number of the first stabilizer that `can_touch` under the case's forces; 1 if none can."""
    touching = can_touch(case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force)
    return touching[0] if touching else 1


def steady_mode(case: Case, rss_force: float, inclination: float) -> tuple[Contact, bool]:
    """The mode of the steady response to a force, in which a case drills once transients have died out.

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
    """The contacts that a chart shows, at most four, most stabilizers first.

    All that the stabilizers that `can_touch` make if there are no more than four. Else all of them together, the
    contact `first` (that of the steady mode), and of `contacts_met` those that oscillate up to the largest ηΠ.
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
