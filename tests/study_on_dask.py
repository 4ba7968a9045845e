"""`boreprop study --dask` on a cluster of two workers, one of which is killed on the way; prints how many cases were
done by then, and the worker's process number.

    python study_on_dask.py CASE.toml STUDY.parquet CASES

In a process of its own, as what Dask leaves behind is not for the tests to clean up.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import dask
import pyarrow.parquet
from distributed import Client, LocalCluster


def rows_in(path: Path) -> int:
    """How many cases a study's file holds."""
    return pyarrow.parquet.ParquetFile(path).metadata.num_rows if path.exists() else 0


def main() -> None:
    """Run the study."""
    case, output, cases = sys.argv[1:]
    with (
        dask.config.set({"distributed.worker.multiprocessing-method": "forkserver"}),  # it is quicker to begin workers
        LocalCluster(2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster,  # type: ignore[no-untyped-call]
        Client(cluster) as client,  # type: ignore[no-untyped-call]
    ):
        victim = next(iter(client.run(os.getpid).values()))
        command = [sys.executable, "-m", "boreprop.cli.app", "study", case, "--output", output]
        command += ["--vary", f"eta_pi=0.005:0.02:{cases}", "--dask", cluster.scheduler_address]
        study = subprocess.Popen(command)
        while study.poll() is None and not rows_in(Path(output)):
            time.sleep(0.01)
        done = rows_in(Path(output))
        os.kill(victim, signal.SIGKILL)
        status = study.wait()
    print(done, victim)
    sys.exit(status)


if __name__ == "__main__":
    main()
