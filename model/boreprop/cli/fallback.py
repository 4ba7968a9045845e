"""Says that the model in Python drills, many times slower than compiled code, where that is not there."""

from functools import cache

from ..run.engines import why_not_native
from .console import warn


@cache
def warn_of_fallback() -> None:
    """Warn, once in a process, if the engine that is chosen by itself is the one in Python, and say what helps."""
    if why := why_not_native():
        warn(f"the python engine drills, which is many times slower, since {why}")
