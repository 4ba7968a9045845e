"""Borehole propagation of a directional drilling system: a delay complementarity model, and analyses of its holes.

Start with a case and simulate it::

    from boreprop import load_case, simulate, summarize

    run = simulate(load_case("case.toml"))
    print(summarize(run).build_rate)

Everything that a script needs can be imported from here. The rest of the package is private and may move.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .analysis.hysteresis import hysteresis as hysteresis
    from .analysis.rippling import find_rippling as find_rippling
    from .analysis.spiral.closed_form import spiral as spiral
    from .analysis.spiral.transverse import transverse_growth as transverse_growth
    from .analysis.spiral.walking import walk_chart as walk_chart
    from .analysis.stability.chart import stability_chart as stability_chart
    from .analysis.stability.roots import critical_eta_pi as critical_eta_pi
    from .analysis.stability.roots import find_roots as find_roots
    from .analysis.steering import steady_response as steady_response
    from .analysis.study.compute import probability as probability
    from .analysis.study.compute import quantiles as quantiles
    from .analysis.study.compute import study as study
    from .analysis.study.design import grid as grid
    from .analysis.study.design import sample as sample
    from .analysis.study.design import vary as vary
    from .analysis.summary import summarize as summarize
    from .analysis.tipping import critical_dogleg as critical_dogleg
    from .case.case import Case as Case
    from .case.file import load_case as load_case
    from .case.formations import Formation as Formation
    from .case.inputs import InputSchedule as InputSchedule
    from .case.inputs import Schedule as Schedule
    from .case.paper import paper_case as paper_case
    from .core.errors import BorepropError as BorepropError
    from .core.ground import Wear as Wear
    from .core.survey import Survey as Survey
    from .core.system import BitRock as BitRock
    from .core.system import BottomHoleAssembly as BottomHoleAssembly
    from .run.engines import engine as engine
    from .run.results import read_trajectory as read_trajectory
    from .run.results import write_trajectory as write_trajectory
    from .run.simulate import simulate as simulate
    from .run.trajectory import Stopped as Stopped
    from .run.trajectory import Trajectory as Trajectory

_HOMES = {  # public name → module
    "BitRock": "core.system",
    "BorepropError": "core.errors",
    "BottomHoleAssembly": "core.system",
    "Case": "case.case",
    "Formation": "case.formations",
    "InputSchedule": "case.inputs",
    "Schedule": "case.inputs",
    "Stopped": "run.trajectory",
    "Survey": "core.survey",
    "Trajectory": "run.trajectory",
    "Wear": "core.ground",
    "critical_dogleg": "analysis.tipping",
    "critical_eta_pi": "analysis.stability.roots",
    "engine": "run.engines",
    "find_rippling": "analysis.rippling",
    "find_roots": "analysis.stability.roots",
    "grid": "analysis.study.design",
    "hysteresis": "analysis.hysteresis",
    "load_case": "case.file",
    "paper_case": "case.paper",
    "probability": "analysis.study.compute",
    "quantiles": "analysis.study.compute",
    "read_trajectory": "run.results",
    "sample": "analysis.study.design",
    "simulate": "run.simulate",
    "spiral": "analysis.spiral.closed_form",
    "stability_chart": "analysis.stability.chart",
    "steady_response": "analysis.steering",
    "study": "analysis.study.compute",
    "summarize": "analysis.summary",
    "transverse_growth": "analysis.spiral.transverse",
    "vary": "analysis.study.design",
    "walk_chart": "analysis.spiral.walking",
    "write_trajectory": "run.results",
}
__all__ = [*_HOMES, "__version__"]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used, so that a command imports only what it needs."""
    from importlib import import_module

    if name == "__version__":
        from importlib.metadata import version

        return version("boreprop")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
