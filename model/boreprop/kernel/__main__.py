"""Compile the kernel for this machine, where the binding looks for it: ``python -m boreprop.kernel``."""

import sys

from ..endings import endings_like_interrupt
from .compiler import CompilerError, build_library

if __name__ == "__main__":
    try:
        with endings_like_interrupt():
            print(build_library())
    except (CompilerError, OSError) as error:
        print("error:", error, file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
