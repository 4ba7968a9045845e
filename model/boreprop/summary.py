"""A run in a dozen numbers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .analysis.rippling import Rippling, Stretch, examine_rippling
from .results import Trajectory

BUILD_LENGTH = 30.0  # m: build rates are told in degrees per 30 m


@dataclass(frozen=True)
class Summary:
    """What an engineer asks of a run first. Inclinations are averages over the ℓ₁ behind the bit.

    Parameters
    ----------
    drilled_length
        m.
    start_inclination, end_inclination
        rad.
    build_rate, largest_build_rate
        Over the whole run, and the largest in size over any 30 m (nan in a shorter run), rad/m; positive builds.
    largest_contact_force
        For each non-ideal stabilizer, in size, N, shape (n − 1,).
    contact_share
        Share of the length each non-ideal stabilizer touches a wall, shape (n − 1,).
    saturation_share
        Share of the length the bit tilt is at its limit.
    rippling
        Whether it ends rippling, with what wave.
    stopped
        Why the run ended before its end, if it did.
    """

    drilled_length: float
    start_inclination: float
    end_inclination: float
    build_rate: float
    largest_build_rate: float
    largest_contact_force: NDArray[np.float64]
    contact_share: NDArray[np.float64]
    saturation_share: float
    rippling: Rippling
    stopped: str | None = None


def summarize(trajectory: Trajectory, length_scale: float) -> Summary:
    """Sum up a run of at least two rows; `length_scale` is ℓ₁, m."""
    length = trajectory["drilled_length"]
    inclination = trajectory["average_inclination[1]"]
    weights = np.gradient(length)
    weights[[0, -1]] /= 2
    later = np.interp(length + BUILD_LENGTH, length, inclination, right=np.nan)
    rates = (later - inclination)[~np.isnan(later)] / BUILD_LENGTH
    drilled = float(length[-1] - length[0])
    return Summary(
        drilled_length=drilled,
        start_inclination=float(inclination[0]),
        end_inclination=float(inclination[-1]),
        build_rate=float(inclination[-1] - inclination[0]) / drilled,
        largest_build_rate=float(rates[np.argmax(np.abs(rates))]) if len(rates) else float("nan"),
        largest_contact_force=np.abs(trajectory.stack("stabilizer_force")).max(axis=0),
        contact_share=np.average(trajectory.stack("stabilizer_contact") != 0, axis=0, weights=weights),
        saturation_share=float(np.average(trajectory["bit_tilt_saturation"] != 0, weights=weights)),
        rippling=examine_rippling(trajectory, length_scale),
        stopped=trajectory.stopped,
    )


def rows(summary: Summary, length_scale: float) -> list[tuple[str, str]]:
    """The lines of a table: what, and how much in the units people use."""
    stabilizers = enumerate(zip(summary.largest_contact_force, summary.contact_share, strict=True), 1)
    return [
        ("drilled length", f"{summary.drilled_length:.1f} m"),
        *([("stopped", summary.stopped)] if summary.stopped else []),
        ("inclination at the start", f"{np.degrees(summary.start_inclination):.2f} °"),
        ("inclination at the end", f"{np.degrees(summary.end_inclination):.2f} °"),
        ("build rate, mean", _rate(summary.build_rate)),
        (f"build rate, largest over {BUILD_LENGTH:g} m", _rate(summary.largest_build_rate)),
        *(
            line
            for i, (force, share) in stabilizers
            for line in (
                (f"stabilizer {i}: largest contact force", f"{force / 1e3:.1f} kN"),
                (f"stabilizer {i}: in contact", f"{share:.0%} of the length"),
            )
        ),
        ("bit tilt saturated", f"{summary.saturation_share:.0%} of the length"),
        *_wave_rows(summary.rippling, length_scale),
    ]


def _rate(change: float) -> str:
    return f"{np.degrees(change) * BUILD_LENGTH:+.2f} °/{BUILD_LENGTH:g} m"


def _wave_rows(wave: Rippling, length_scale: float) -> list[tuple[str, str]]:
    if not wave.ripples:
        return [("rippling", "no")]
    return [
        ("rippling", f"yes: {wave.wavelength:.2f} m long ({wave.wavelength / length_scale:.2f} ℓ₁)"),
        ("ripple of the inclination", f"±{np.degrees(wave.amplitude):.2f} °"),
        ("ripple of the hole axis", f"±{1e3 * wave.axis_amplitude:.1f} mm"),
        ("ripple, from wave to wave", f"length ±{wave.spread:.2f} m, amplitude {_rate(wave.amplitude_drift)}"),
        ("modes of a wave", "\n".join(map(_words, wave.modes))),
    ]


def _words(stretch: Stretch) -> str:
    touching = [f"{i} {'lower' if wall > 0 else 'upper'}" for i, wall in enumerate(stretch.contact, 1) if wall]
    limit = [f"{'+' if stretch.tilt > 0 else '−'}ψ*"] if stretch.tilt else []
    return f"{' '.join(touching + limit) or 'free'} {stretch.share:.0%}"
