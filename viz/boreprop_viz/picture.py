"""Takes pictures of a recording without a screen, with Rerun's viewer under remote control.

On Linux it draws with Mesa's software Vulkan driver where that is installed (Debian: mesa-vulkan-drivers and
libvulkan1), so that no graphics card is needed and the pictures are the same on every machine. Pictures in the light
theme need a virtual screen (Debian: xvfb), since only a viewer with a window reads that setting.
"""

import io
import os
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

from PIL import Image
from rerun.experimental import View, ViewerClient, ViewReport

from .feeder import PROGRAM
from .ports import LOOPBACK, free_port

T = TypeVar("T")

SOFTWARE_DRIVERS = sorted(Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json"))
LOG = "warn,re_renderer=error,egui_wgpu=error"  # without warnings that the software driver is slow
# the settings of a viewer in the light theme; those of another version it would not read
LIGHT = f'{{"egui": "(options:(theme_preference:Light))", "rerun.version": "{version("rerun-sdk")}"}}'
GREETING = 30  # frames drawn first without a window, since a note of the viewer's covers the first 16
PATIENCE = 60.0  # s to wait for an answer: a viewer on a busy machine may take half of it to start


class Viewer:
    """A viewer without a screen, showing a recording.

    Every method raises `TimeoutError` or `ConnectionError` if the viewer does not answer.
    """

    def __init__(self, client: ViewerClient) -> None:
        self.client = client

    def seek(self, tick: int) -> None:
        """Move the cursor to a tick of the timeline, and stop there."""
        self.client.set_time(sequence=tick, play_state="paused")

    def views(self) -> list[View]:
        """All views, those in hidden tabs too."""
        return self.client.get_state().views

    def reports(self, view: View) -> list[ViewReport]:
        """The errors that a view reports; a view that is not being drawn reports none."""
        return [report for now in self.views() if now.view_id == view.view_id for report in now.reports]

    def warnings(self) -> list[str]:
        """The warnings of the viewer so far."""
        return [entry.message for entry in self.client.get_logs()]

    def picture(self, view: View | None = None) -> Image.Image:
        """A picture of the whole viewer, or of one view drawn alone, even if its tab is hidden."""
        self._maximize(view)
        shots = [b""]

        def steady() -> bytes:
            shots.append(self.client.take_screenshot(view.view_id if view else None))
            return shots[-1] if shots[-1] == shots[-2] else b""

        return Image.open(io.BytesIO(wait_for(steady, "the picture must stop changing"))).convert("RGB")

    def _maximize(self, view: View | None) -> None:
        blueprint = self.client.get_blueprint(of="recording").blueprint
        viewport = blueprint["/viewport"]["ViewportBlueprint"]
        viewport.pop("maximized", None)
        if view:
            viewport["maximized"] = view.view_id
        self.client.set_blueprint(blueprint, of="recording")


@contextmanager
def viewer(recording: Path, width: int = 1600, height: int = 1000, *, light: bool = False) -> Iterator[Viewer]:
    """Start a viewer of that size, in pixels, on a recording. It does not read or change any of the user's settings.

    Its theme is dark or `light`.

    Raises
    ------
    RuntimeError
        If the viewer does not start.
    FileNotFoundError
        If there is no such recording, or for the light theme no program Xvfb.
    """
    port = free_port()
    arguments = f"--hide-welcome-screen --bind {LOOPBACK} --port {port} --window-size {width}x{height}"
    with TemporaryDirectory() as folder, screen(width, height) if light else nullcontext("") as display:
        if light:
            settings = Path(folder, "rerun", "app.ron")
            settings.parent.mkdir()
            settings.write_text(LIGHT)
        process = subprocess.Popen(
            [PROGRAM, *arguments.split(), "--persist-state" if light else "--headless"],
            env=environment(folder) | {"DISPLAY": display},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            client = wait_for(lambda: connected(process, port), "the viewer must answer")
            client.open(str(recording.resolve(strict=True)))
            wait_for(lambda: not client.get_state().loading, f"{recording}: must load")
            if not light:
                client.capture_profile_trace(str(Path(folder, "profile")), num_frames=GREETING)  # draws as many
            yield Viewer(client)
        finally:
            process.terminate()
            process.wait(10.0)


@contextmanager
def screen(width: int, height: int) -> Iterator[str]:
    """Start a virtual screen for a window of that size, pixels; yields its name, as in the variable DISPLAY."""
    outside = f"{2 * width + 2}x{2 * height + 2}x24"  # so that its pointer, which is in the middle, points at nothing
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", outside, "-nolisten", "tcp"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        assert process.stdout
        try:
            yield f":{process.stdout.readline().strip()}"
        finally:
            process.terminate()


def environment(folder: str) -> dict[str, str]:
    """Environment variables of a viewer with its home in `folder`, without statistics, on the software driver."""
    homes = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR")
    variables = os.environ | dict.fromkeys(homes, folder) | {"CI": "true", "RUST_LOG": LOG}
    if SOFTWARE_DRIVERS:
        variables["VK_ICD_FILENAMES"] = os.pathsep.join(map(str, SOFTWARE_DRIVERS))
    return variables


def connected(process: subprocess.Popen[bytes], port: int) -> ViewerClient | None:
    """A connection to the viewer, once it draws; None before that; `RuntimeError` if it has ended."""
    if process.poll() is not None:
        raise RuntimeError(
            "the viewer must find a Vulkan driver (Debian: mesa-vulkan-drivers and libvulkan1), "
            f"got exit status {process.returncode}"
        )
    try:
        client = ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")
        client.take_screenshot()
    except ConnectionError:
        return None
    return client


def wait_for(ask: Callable[[], T | None], must: str) -> T:
    """Call `ask` until its answer is not empty; `TimeoutError` after `PATIENCE`."""
    deadline = time.monotonic() + PATIENCE
    while not (answer := ask()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"{must} within {PATIENCE:g} s")
        time.sleep(0.05)
    return answer
