"""modelDescription.xml of the borehole FMU, from the table of quantities."""

import os
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import metadata
from math import isfinite
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from boreprop.core.quantities import VARIABLES, Quantity, Structure, followed
from boreprop.core.system import LEAST_SPAN
from boreprop.errors import InputError
from boreprop.units import UNITS

from .licenses import copyright_line

LOG_CATEGORIES = {
    "logStatusWarning": "What was not taken over, and where the BHA leaves the hole, though nothing fails.",
    "logStatusDiscard": "Why a step was discarded.",
    "logStatusError": "Bad parameters, outputs that cannot be computed, and calls that must not be made.",
}
LEAST_POSITIVE = 1e-300  # for "> 0", which FMI cannot say: what is made of it, and its reciprocal, are finite


def model_description(
    identifier: str,
    guid: str,
    structure: int | Structure,
    start: Mapping[str, float | str],
    *,
    stop_time: float,
    step_size: float,
    capabilities: Mapping[str, bool | int],
    source_files: Sequence[str] = (),
) -> bytes:
    """The XML document.

    Parameters
    ----------
    identifier
        Model name and file name of the binaries.
    guid
        The FMU's identity.
    structure
        How the BHA is made up; or the number of stabilizers on the paper's beam.
    start
        Start value of every input and parameter, by scalar name.
    stop_time, step_size
        The default experiment, s.
    capabilities
        Attributes of the element CoSimulation.
    source_files
        The files in the folder sources/ that are to be compiled.
    """
    about = metadata("boreprop")
    attributes = {
        "fmiVersion": "2.0",
        "modelName": identifier,
        "guid": guid,
        "description": "Borehole propagation of a directional drilling system: a delay complementarity model",
        "author": about["Author"],
        "version": about["Version"],
        "copyright": copyright_line(),
        "license": about["License-Expression"],
        "generationTool": f"boreprop {about['Version']}",
        **_date(guid),
        "variableNamingConvention": "structured",
    }
    root = Element("fmiModelDescription", attributes)
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
    tolerance = repr(start["relative_tolerance"])
    experiment = {"startTime": "0.0", "stopTime": repr(stop_time), "tolerance": tolerance, "stepSize": repr(step_size)}
    SubElement(root, "DefaultExperiment", experiment)
    scalars = [(name, quantity) for quantity in VARIABLES for name in quantity.names(structure)]
    variables = SubElement(root, "ModelVariables")
    for reference, (name, quantity) in enumerate(scalars):
        _add_variable(variables, name, reference, quantity, start)
    _add_structure(SubElement(root, "ModelStructure"), scalars, structure)
    indent(root)
    document: bytes = tostring(root, encoding="utf-8", xml_declaration=True)
    return document + b"\n"


def _date(guid: str) -> dict[str, str]:
    """The date that $SOURCE_DATE_EPOCH gives; none without it, for every build would differ.

    A draft, from which the guid is derived, has neither: the date is no part of what an FMU is.
    """
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not (guid and seconds):
        return {}
    try:
        date = datetime.fromtimestamp(int(seconds), UTC)
    except (ValueError, OverflowError, OSError) as error:
        raise InputError(f"SOURCE_DATE_EPOCH: must be a whole number of seconds since 1970, got {seconds!r}") from error
    return {"generationDateAndTime": date.strftime("%Y-%m-%dT%H:%M:%SZ")}


def _least(quantity: Quantity, index: int) -> float:
    """The least value that is accepted of the element with this index, from 1 on; −∞ if every value is."""
    if quantity.name == "stabilizer_position":
        return LEAST_SPAN * index
    if quantity.name == "active_weight_on_bit":
        return 0.0  # off bottom
    return LEAST_POSITIVE if quantity.above == 0.0 else quantity.at_least


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
        attributes |= {"variability": "tunable" if quantity.tunable else "fixed", "initial": "exact"}
    if quantity.role == "output":
        attributes |= {"initial": "calculated"}
    scalar = SubElement(variables, "ScalarVariable", attributes)
    typed = SubElement(scalar, quantity.kind)
    if quantity.kind == "Real":
        typed.set("unit", quantity.unit or "1")
        if display := UNITS[quantity.unit].ascii:
            typed.set("displayUnit", display)
        typed.set("nominal", repr(quantity.nominal))
    number = repr if quantity.kind == "Real" else "{:.0f}".format
    least = _least(quantity, int(name.rpartition("[")[2].rstrip("]")) if "[" in name else 1)
    if isfinite(least):
        typed.set("min", number(least))
    if isfinite(quantity.at_most):
        typed.set("max", number(quantity.at_most))
    if name in start:
        value = start[name]
        typed.set("start", value if isinstance(value, str) else number(value))


def _add_structure(element: Element, scalars: list[tuple[str, Quantity]], structure: int | Structure) -> None:
    """What outputs depend on: while stepping inputs only, at the start parameters too."""
    index = {name: str(i) for i, (name, _) in enumerate(scalars, start=1)}
    for part, roles in (("Outputs", ("input",)), ("InitialUnknowns", ("input", "parameter"))):
        unknowns = SubElement(element, part)
        for name, quantity in scalars:
            if quantity.role == "output":
                follows = followed(quantity, structure)
                sources = [one for one, of in scalars if of.role in roles and of.name in follows]
                kinds = " ".join(["dependent"] * len(sources))
                depends_on = " ".join(index[one] for one in sources)
                SubElement(unknowns, "Unknown", index=index[name], dependencies=depends_on, dependenciesKind=kinds)
