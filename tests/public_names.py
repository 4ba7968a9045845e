"""The public names of boreprop, for the tests that look at each of them."""

import boreprop

PUBLIC = [name for name in boreprop.__all__ if name != "__version__"]
ANALYSES = (
    "critical_dogleg",
    "critical_eta_pi",
    "find_rippling",
    "find_roots",
    "grid",
    "hysteresis",
    "sample",
    "simulate",
    "spiral",
    "stability_chart",
    "steady_response",
    "summarize",
    "transverse_growth",
    "vary",
    "walk_chart",
)
"""Functions that take a case or a run first."""
EXPLAINED = (*ANALYSES, "Trajectory", "load_case", "paper_case", "read_trajectory", "study")
"""The main names, each of which has an example."""
OTHERS = (
    "BitRock",
    "BorepropError",
    "BottomHoleAssembly",
    "Case",
    "Formation",
    "InputSchedule",
    "Schedule",
    "Stopped",
    "Survey",
    "__version__",
    "engine",
    "write_trajectory",
)
"""The other names that scripts need."""
