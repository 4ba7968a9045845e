"""How long the viewer takes to show another place of a long run: from a jump of the cursor to the picture there.

python benchmarks/viewer_seek.py
"""

import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from boreprop.case.file import load_case
from boreprop.run.simulate import simulate
from boreprop_viz.picture import Viewer, viewer
from boreprop_viz.record import record
from boreprop_viz.track import TIMELINE

LENGTH, INTERVAL = 3000.0, 0.1  # m: 30 001 rows
PLACES = (0.9, 0.1, 0.5, 0.98, 0.3, 0.75, 0.02, 0.6, 0.999)  # of the length, to and fro
SIZE = 1600, 900
CASES = Path(__file__).parents[1] / "examples"


def main() -> None:
    """Print, for each case or each recording given, the median and the longest time of a jump, s."""
    with TemporaryDirectory() as folder:
        for recording in map(Path, sys.argv[1:]) if sys.argv[1:] else long_runs(Path(folder)):
            with viewer(recording, *SIZE) as shown:
                times = [jump(shown, place) for place in PLACES]
                rest = median(at_rest(shown) for _ in PLACES)
            each = " ".join(f"{seconds:.2f}" for seconds in times)
            print(
                f"{recording.stem}: {median(times):.2f} s to jump (bar 1.5), at most {max(times):.2f} ({each}); "
                f"{rest:.2f} s for a picture at rest",
                flush=True,
            )


def long_runs(folder: Path) -> list[Path]:
    """Recordings of two cases drilled on to `LENGTH`."""
    made = []
    for name in ("paper_case", "build_section"):
        case = replace(load_case(CASES / f"{name}.toml"), length=LENGTH)
        made.append(folder / f"{name}.rrd")
        record(simulate(case, sample_interval=INTERVAL), save=made[-1])
    return made


def jump(shown: Viewer, place: float) -> float:
    """Seconds from a jump of the cursor to the first picture that is another one and does not change any more."""
    before = shown.client.take_screenshot()
    begin = time.perf_counter()
    shown.client.set_time(TIMELINE, sequence=round(1000 * place * LENGTH), play_state="paused")
    pictures, ends = [before, before], [0.0, 0.0]
    while pictures[-1] == before or pictures[-1] != pictures[-2]:
        pictures.append(shown.client.take_screenshot())
        ends.append(time.perf_counter() - begin)
    return ends[-2]


def at_rest(shown: Viewer) -> float:
    """Seconds for a picture of what is there already: what of a jump is not the viewer's doing."""
    begin = time.perf_counter()
    shown.client.take_screenshot()
    return time.perf_counter() - begin


if __name__ == "__main__":
    main()
