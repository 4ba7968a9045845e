"""What a steel collar in mud adds to the beam: its bending stiffness and its buoyant weight."""

from math import pi

from ..units import STANDARD_GRAVITY

YOUNGS_MODULUS = 206e9  # Pa, of steel
STEEL_DENSITY = 7850.0  # kg/m³


def flexural_stiffness(outer_diameter: float, inner_diameter: float) -> float:
    """EI = E π/64 (D⁴ − d⁴) of a steel collar, N·m², from its diameters, m."""
    return YOUNGS_MODULUS * pi / 64 * (outer_diameter**4 - inner_diameter**4)


def buoyant_weight(
    outer_diameter: float, inner_diameter: float, mud_density: float, density: float = STEEL_DENSITY
) -> float:
    """Weight per length, N/m, of a collar inside and outside of which there is mud.

    Parameters
    ----------
    outer_diameter, inner_diameter
        Of the collar, m.
    mud_density
        Density of the mud, kg/m³.
    density
        That of the collar, kg/m³: steel unless told otherwise.
    """
    area = pi / 4 * (outer_diameter**2 - inner_diameter**2)
    return area * (density - mud_density) * STANDARD_GRAVITY
