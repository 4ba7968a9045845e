"""What keeps pandas from being loaded for nothing."""

import sys
from importlib.abc import MetaPathFinder

import numpy as np
import pyarrow as pa


class _NoPandas(MetaPathFinder):
    """Says that pandas is not installed, and leaves all else to the other finders."""

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> None:  # noqa: ARG002
        if fullname == "pandas":
            raise ModuleNotFoundError("pandas is not needed here", name=fullname)


def skip_pandas_check() -> None:
    """Let pyarrow, on which Rerun builds, find no pandas the one time that it looks.

    When pyarrow is first given an array it loads pandas, a third of a second, to see whether the array is one of its
    series; there is no option against that. Ours are numpy's. Whoever imports pandas after this call gets it.
    """
    finder = _NoPandas()
    sys.meta_path.insert(0, finder)
    try:
        pa.array(np.zeros(1))
    finally:
        sys.meta_path.remove(finder)
