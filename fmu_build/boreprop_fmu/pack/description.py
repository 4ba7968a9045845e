"""modelDescription.xml of the borehole FMU, from the table of quantities."""

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from math import isfinite
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from boreprop.core.quantities import VARIABLES, Quantity
from boreprop.units import UNITS

LOG_CATEGORIES = {
    "logStatusError": "What was called wrongly, and bad parameters.",
    "logStatusDiscard": "Why a step was discarded.",
}


def model_description(
    identifier: str,
    guid: str,
    n: int,
    start: Mapping[str, float | str],
    *,
    stop_time: float,
    step_size: float,
    capabilities: Mapping[str, bool],
    source_files: Sequence[str] = (),
) -> bytes:
    """The XML document.

    Parameters
    ----------
    identifier
        Model name and file name of the binaries.
    guid
        The FMU's identity.
    n
        Number of stabilizers.
    start
        Start value of every input and parameter, by scalar name.
    stop_time, step_size
        The default experiment, s.
    capabilities
        Attributes of the element CoSimulation.
    source_files
        The files in the folder sources/ that are to be compiled.
    """
    root = Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=identifier,
        guid=guid,
        description="Borehole propagation of a directional drilling system: a delay complementarity model",
        version=version("boreprop"),
        generationTool=f"boreprop {version('boreprop')}",
        variableNamingConvention="structured",
    )
    flags = {name: str(value).lower() for name, value in capabilities.items()}
    simulation = SubElement(root, "CoSimulation", {"modelIdentifier": identifier, **flags})
    if source_files:
        files = SubElement(simulation, "SourceFiles")
        for name in source_files:
            SubElement(files, "File", name=name)
    _add_units(SubElement(root, "UnitDefinitions"))
    categories = SubElement(root, "LogCategories")
    for name, meaning in LOG_CATEGORIES.items():
        SubElement(categories, "Category", name=name, description=meaning)
    SubElement(root, "DefaultExperiment", startTime="0.0", stopTime=repr(stop_time), stepSize=repr(step_size))
    scalars = [(name, quantity) for quantity in VARIABLES for name in quantity.names(n)]
    variables = SubElement(root, "ModelVariables")
    for reference, (name, quantity) in enumerate(scalars):
        _add_variable(variables, name, reference, quantity, start)
    _add_structure(SubElement(root, "ModelStructure"), scalars)
    indent(root)
    document: bytes = tostring(root, encoding="utf-8", xml_declaration=True)
    return document + b"\n"


def _add_units(units: Element) -> None:
    for name, unit in UNITS.items():
        element = SubElement(units, "Unit", name=name or "1")
        SubElement(element, "BaseUnit", {symbol: str(exponent) for symbol, exponent in unit.base.items()})
        if unit.ascii:
            SubElement(element, "DisplayUnit", name=unit.ascii, factor=repr(unit.factor))


def _add_variable(
    variables: Element, name: str, reference: int, quantity: Quantity, start: Mapping[str, float | str]
) -> None:
    source = ", ".join(part for part in (quantity.symbol, quantity.equation and f"eq. {quantity.equation}") if part)
    attributes = {
        "name": name,
        "valueReference": str(reference),
        "description": f"{quantity.meaning} [{source}]" if source else quantity.meaning,
        "causality": quantity.role,
        "variability": "continuous" if quantity.kind == "Real" else "discrete",
    }
    if quantity.role == "parameter":
        attributes |= {"variability": "fixed", "initial": "exact"}
    if quantity.role == "output":
        attributes |= {"initial": "calculated"}
    scalar = SubElement(variables, "ScalarVariable", attributes)
    typed = SubElement(scalar, quantity.kind)
    if quantity.kind == "Real":
        typed.set("unit", quantity.unit or "1")
        if display := UNITS[quantity.unit].ascii:
            typed.set("displayUnit", display)
        typed.set("nominal", repr(quantity.nominal))
    number = repr if quantity.kind == "Real" else "{:d}".format
    # FMI has no way to say that a value must be above a bound and not equal to it; such a bound is left out
    if isfinite(quantity.at_least):
        typed.set("min", number(quantity.at_least))
    if isfinite(quantity.at_most):
        typed.set("max", number(quantity.at_most))
    if name in start:
        value = start[name]
        typed.set("start", value if isinstance(value, str) else repr(value))


def _add_structure(structure: Element, scalars: list[tuple[str, Quantity]]) -> None:
    index = {name: str(i) for i, (name, _) in enumerate(scalars, start=1)}
    outputs = [(name, quantity) for name, quantity in scalars if quantity.role == "output"]
    unknowns = SubElement(structure, "Outputs")
    for name, quantity in outputs:
        depends_on = " ".join(index[source] for source in quantity.follows)
        SubElement(unknowns, "Unknown", index=index[name], dependencies=depends_on)
    unknowns = SubElement(structure, "InitialUnknowns")
    for name, _ in outputs:  # without a list of dependencies, they depend on everything
        SubElement(unknowns, "Unknown", index=index[name])
