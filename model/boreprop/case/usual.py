"""What is usual of a bottom-hole assembly, so that a number in another unit is noticed before it is drilled.

These are no constraints: a case may be drilled that no rig has. What cannot be is refused where a `Case` is made.
"""

from math import degrees

from .case import Case

USUAL = {  # key of the case file → from, to, unit there
    # Steel collars from 3 1/8 x 1 1/4 in (EI 0.39 MN·m², 320 N/m in air) to 11 x 3 in (61 MN·m², 4370 N/m), the ends of
    # the table of API Spec 7-1, with a factor of 3 for smaller tools, flex collars and solid bodies, and with buoyancy.
    "bha.flexural_stiffness": (1e5, 2e8, "N·m²"),
    "bha.distributed_weight": (100.0, 6e3, "N/m"),
    # Bits are made from about 2 3/8 in to 36 in.
    "bit.diameter": (0.05, 1.0, "m"),
    # A gauge of 0.1 to 1 m with 1 to 10 mm of play turns by so much; the paper has 2°.
    "bit.tilt_limit_deg": (0.05, 5.0, "°"),
    # From a bit that barely drills (the paper's case: 1.6 kN) to the heaviest bits in large holes, some 500 kN.
    "drilling.active_weight_on_bit": (300.0, 5e5, "N"),
    # The pads of rotary steerable tools press with a few kN to some tens of kN.
    "rss.force": (100.0, 1e5, "N"),
    # From the paper's softest rock over stiff near-bit assemblies to its hardest over slender ones, and a decade more.
    "ηΠ": (1e-5, 100.0, ""),
}
"""Far outside of these ranges no bottom-hole assembly is; `unusual` leaves out a weight and a force of 0."""


def unusual(case: Case) -> list[str]:
    """What of a case is far from any bottom-hole assembly, and whether its hole is shorter than its assembly.

    Returns
    -------
    list of str
        A phrase for each: key, value, usual range; none for a usual case.
    """
    profiles = case.profiles()
    values = {
        "bha.flexural_stiffness": [case.bha.flexural_stiffness],
        "bha.distributed_weight": [case.bha.distributed_weight],
        "bit.diameter": [case.bit_diameter],
        "bit.tilt_limit_deg": [degrees(case.bit.tilt_limit)],
        "drilling.active_weight_on_bit": profiles["active_weight_on_bit"].values,
        "rss.force": [max(map(abs, profiles["rss_force"].values))],
        "ηΠ": [case.eta_pi],
    }
    found = [
        f"{key}: is usually {low:g} to {high:g} {unit}".rstrip() + f", got {value:g}"
        for key, (low, high, unit) in USUAL.items()
        for value in [value for value in values[key] if value != 0.0 and not low <= value <= high][:1]
    ]
    depth, reach = case.survey.measured_depth, case.bha.stabilizer_positions[-1]
    if depth[-1] - depth[0] < reach * (1 - 1e-9):
        shorter = f"spans {depth[-1] - depth[0]:g} m, less than the {reach:g} m of the BHA"
        found.append(f"hole.measured_depth: {shorter}: the hole is extended straight above its first station")
    first = min((formation.depth for formation in case.formations), default=0.0) if case.in_layers else 0.0
    if case.true_vertical_depth == 0.0 and first > case.length:
        deep = f"{first:g} m is deeper than a bit that starts at 0 m gets in {case.length:g} m"
        found.append(f"formation.true_vertical_depth: {deep}: give hole.true_vertical_depth, that of the bit")
    return found
