"""A study on a cluster of two Dask workers, one of which is killed on the way; prints its process number.

    python study_on_dask.py FOLDER

In a process of its own, as what Dask leaves behind is not for the tests to clean up.
"""

import os
import signal
import sys
from functools import partial
from pathlib import Path

from distributed import Client, LocalCluster

import study_functions
from boreprop.analysis.study.run import study
from boreprop.analysis.study.table import Line


def main() -> None:
    """Run the study."""
    folder, killed = Path(sys.argv[1]), list[int]()

    def kill_a_worker(_: Line) -> None:
        if not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    with (
        LocalCluster(2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster,  # type: ignore[no-untyped-call]
        Client(cluster) as client,  # type: ignore[no-untyped-call]
    ):
        study(
            study_functions.numbered(40),
            partial(study_functions.counted, folder, 0.1),
            executor=client.get_executor(),
            output=folder / "study.parquet",
            on_result=kill_a_worker,
        )
    print(*killed)


if __name__ == "__main__":
    main()
