"""Where things are in the repository, and the headers of FMI 2.0."""

from importlib.util import find_spec
from pathlib import Path

TESTS = Path(__file__).parent
ROOT = TESTS.parent
EXAMPLES = ROOT / "examples"
HOSTS = TESTS / "hosts"

_FMPY = find_spec("fmpy")
assert _FMPY
assert _FMPY.origin
FMI_HEADERS = Path(_FMPY.origin).parent / "c-code"  # fmpy's own, which leave out the prefix of the functions
