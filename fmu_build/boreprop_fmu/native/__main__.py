"""Compile the binaries that native FMUs are packed with: ``python -m boreprop_fmu.native [all|PLATFORM …]``.

Without a name the one for this machine, with its own compiler where ziglang is not installed.
"""

import sys

from boreprop.endings import endings_like_interrupt
from boreprop.errors import BorepropError

from .binaries import PLATFORMS, build_binaries

if __name__ == "__main__":
    try:
        with endings_like_interrupt():
            for binary in build_binaries(PLATFORMS if sys.argv[1:] == ["all"] else sys.argv[1:]):
                print(binary, flush=True)
    except (BorepropError, OSError) as error:
        print("error:", error, file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
