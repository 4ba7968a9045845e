"""The steering response as a picture: build rate and bit tilt over the steering force."""

from math import degrees

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...units import UNITS
from ..tables.steering import SteeringSummary, at_force, force_text, per_build_length, touching
from ..tables.steering_as_built import SteeringAsBuilt
from .drawing import COLOURS

MORE_COLOURS = (*COLOURS, "#56B4E9", "#D55E00", "#000000")  # of Okabe and Ito, without the yellow, pale on white


def draw(summary: SteeringSummary) -> Figure:
    """Draw build rate and bit tilt over the force: a colour for each set of contacts, dashed if the tilt saturates."""
    figure, rates, tilts = _panels(summary.active_weight_on_bit, summary.eta_pi, summary.inclination)
    force, angle = UNITS["N"], UNITS["rad"]
    kinks = [summary.without_gravity[0].start, *(piece.end for piece in summary.without_gravity)]
    forces = [force.factor * kink.rss_force for kink in kinks]
    rates.plot(forces, [per_build_length(kink.build_rate) for kink in kinks], ":", color="0.5", label="without gravity")
    colours: dict[str, str] = {}
    for piece in summary.curve:
        contacts = touching(piece.start, piece.end)
        if contacts not in colours:
            colours[contacts] = MORE_COLOURS[len(colours) % len(MORE_COLOURS)]
            rates.plot([], [], color=colours[contacts], label=f"on a wall: {contacts}")
        style = "--" if piece.start.bit_tilt_saturation else "-"
        ends = (piece.start, piece.end)
        forces = [force.factor * end.rss_force for end in ends]
        rates.plot(forces, [per_build_length(end.build_rate) for end in ends], style, color=colours[contacts])
        tilts.plot(forces, [angle.factor * end.bit_tilt for end in ends], style, color=colours[contacts])
    if any(piece.start.bit_tilt_saturation for piece in summary.curve):
        rates.plot([], [], "--", color="0.4", label="bit tilt at its limit")
    _mark(rates, summary)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def draw_as_built(summary: SteeringAsBuilt) -> Figure:
    """Draw build rate and bit tilt over the force for a BHA as it is built; dots where its body lies on the wall."""
    figure, rates, tilts = _panels(summary.active_weight_on_bit, summary.eta_pi, summary.inclination)
    forces = [UNITS["N"].factor * response.rss_force for response in summary.responses]
    built = [per_build_length(response.build_rate) for response in summary.responses]
    rates.plot(forces, built, color=COLOURS[0], label="build rate")
    touches = [bool(response.body_contact_force) for response in summary.responses]
    if any(touches):
        where = [at for at, touching in enumerate(touches) if touching]
        rates.plot(
            [forces[at] for at in where], [built[at] for at in where], ".", color=COLOURS[0], label="body on the wall"
        )
    tilts.plot(forces, [UNITS["rad"].factor * response.bit_tilt for response in summary.responses], color=COLOURS[0])
    _mark(rates, summary)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def _panels(active_weight_on_bit: float, eta_pi: float, inclination: float) -> tuple[Figure, Axes, Axes]:
    """A figure with its title, and its panels for build rates and tilts."""
    weight = f"{force_text(active_weight_on_bit)} active weight on bit (ηΠ = {eta_pi:.3g})"
    setting = f"{degrees(inclination):.4g}° inclination, {weight}"
    force, angle = UNITS["N"], UNITS["rad"]
    figure = Figure(figsize=(9, 8.5), layout="constrained")
    figure.suptitle(f"Steady response to the steering force at {setting}")
    rates, tilts = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    rates.set_ylabel(UNITS["rad/m"].heading("build rate"))
    tilts.set_ylabel(angle.heading("bit tilt"))
    tilts.set_xlabel(force.heading("steering force, positive to the high side"))
    for panel in (rates, tilts):
        panel.grid(alpha=0.3)
        panel.axhline(0.0, color="0.4", linewidth=0.8)
    return figure, rates, tilts


def _mark(rates: Axes, summary: SteeringSummary | SteeringAsBuilt) -> None:
    """Mark the forces that hold the inclination, and those with the highest and the lowest build rate."""
    force = UNITS["N"]
    for response in summary.holding:
        label = f"holds at {force_text(response.rss_force, '+')}"
        at = force.factor * response.rss_force
        rates.plot(at, 0.0, "o", color="black", markerfacecolor="white", zorder=3, label=label)
    for what, marker, response in (("highest", "^", summary.highest), ("lowest", "v", summary.lowest)):
        point = force.factor * response.rss_force, per_build_length(response.build_rate)
        rates.plot(*point, marker, color="black", zorder=3, label=f"{what} build rate: {at_force(response)}")
