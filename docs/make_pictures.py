"""Draw the pictures of the viewer anew: ``python docs/make_pictures.py``.

Needs the extra ``viz``, and on a machine without a graphics card Mesa's software Vulkan driver (Debian:
mesa-vulkan-drivers and libvulkan1).
"""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image, ImageChops

from boreprop.case.file import load_case
from boreprop.case.tables import read_survey
from boreprop.replacing import replacing
from boreprop.run.simulate import simulate
from boreprop_fmu.host.drive import FmuRun
from boreprop_fmu.pack.build import build_fmu
from boreprop_viz.picture import Viewer, viewer
from boreprop_viz.record import record

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
LIVE_AT = 3093.9  # m, just before the end of what is drilled in the live run, where it is said to be interrupted
MENU = 37  # pixels at the top
COLOURS = 256  # of a palette: half the size of a picture, and nobody sees it


def main() -> None:
    """Draw them all."""
    paper = load_case(EXAMPLES / "paper_case.toml")
    ripples = simulate(paper)
    heavier = simulate(replace(paper, active_weight_on_bit=16 * paper.active_weight_on_bit))
    with TemporaryDirectory() as name:
        recording = Path(name, "run.rrd")
        record({"paper_case": ripples}, save=recording)
        with viewer(recording) as shown:
            keep(whole(shown, 212.5), "rippling")
            keep(bit_frame(shown, 212.5), "bit_frame")
        record({"paper_case": ripples, "more_weight": heavier}, save=recording)
        with viewer(recording) as shown:
            keep(whole(shown, 150.0), "overlaid")
        record({"spiral": simulate(load_case(EXAMPLES / "spiral.toml"))}, save=recording)
        with viewer(recording) as shown:
            keep(whole(shown, 212.5), "spiral")
        drill_for_a_while(Path(name, "build_section.fmu"), recording, rows=5000)
        with viewer(recording) as shown:
            keep(whole(shown, LIVE_AT), "live")


def drill_for_a_while(fmu: Path, recording: Path, rows: int) -> None:
    """Record what a viewer shows in the middle of a live run."""

    def stop(done: float) -> None:
        if done >= rows:
            raise KeyboardInterrupt

    run = FmuRun(build_fmu(load_case(EXAMPLES / "build_section.toml"), fmu))
    with suppress(KeyboardInterrupt):
        record({fmu.stem: run}, plan=read_survey(EXAMPLES / "build_section_plan.csv"), save=recording, progress=stop)


def whole(shown: Viewer, depth: float) -> Image.Image:
    """The viewer without its menu, its cursor at a measured depth, m."""
    shown.seek(round(1000 * depth))
    picture = shown.picture()
    return picture.crop((0, MENU, *picture.size))


def bit_frame(shown: Viewer, depth: float) -> Image.Image:
    """The bit frame alone, its cursor at a measured depth, m."""
    shown.seek(round(1000 * depth))
    [view] = [view for view in shown.views() if view.origin.strip("/") == "bit_frame"]
    picture = shown.picture(view)
    ground = Image.new(picture.mode, picture.size, picture.getpixel((0, 0)))
    return picture.crop(ImageChops.difference(picture, ground).getbbox())


def keep(picture: Image.Image, name: str) -> None:
    """Write a picture beside this file."""
    with replacing(HERE / f"{name}.png") as draft:
        picture.quantize(COLOURS, dither=Image.Dither.NONE).save(draft, format="PNG", optimize=True)


if __name__ == "__main__":
    main()
