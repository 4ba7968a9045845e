"""Pictures of a recording without a screen: Rerun's viewer, drawing headless, under remote control.

On Linux it draws with Mesa's software Vulkan driver where that is installed (Debian: mesa-vulkan-drivers and
libvulkan1), so that no graphics card is needed and the pictures are the same on every machine.
"""

import io
import os
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

from PIL import Image
from rerun.experimental import View, ViewerClient, ViewReport

from .sinks import LOOPBACK, PROGRAM, free_port

T = TypeVar("T")

SOFTWARE_DRIVERS = sorted(Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json"))
LOG = "warn,re_renderer=error,egui_wgpu=error"  # that the driver is slow is no news
GREETING = 30  # frames; the viewer's note of where it listens covers the first 16
PATIENCE = 60.0  # s


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
        """What a view that is being drawn says went wrong; one that is not being drawn says nothing."""
        return [report for now in self.views() if now.view_id == view.view_id for report in now.reports]

    def warnings(self) -> list[str]:
        """What the viewer has warned of so far."""
        return [entry.message for entry in self.client.get_logs()]

    def picture(self, view: View | None = None) -> Image.Image:
        """Picture of the whole viewer, or of one view drawn alone, which brings it out of a hidden tab too."""
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
def viewer(recording: Path, width: int = 1600, height: int = 1000) -> Iterator[Viewer]:
    """Run a viewer of that size, in pixels, on a recording; it neither reads nor leaves anything of the user's.

    Raises
    ------
    RuntimeError
        If the viewer does not start.
    FileNotFoundError
        If there is no such recording.
    """
    port = free_port()
    arguments = f"--headless --hide-welcome-screen --bind {LOOPBACK} --port {port} --window-size {width}x{height}"
    with TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [PROGRAM, *arguments.split()],
            env=environment(folder),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            client = wait_for(lambda: connected(process, port), "the viewer must answer")
            client.open(str(recording.resolve(strict=True)))
            wait_for(lambda: not client.get_state().loading, f"{recording}: must load")
            client.capture_profile_trace(str(Path(folder, "profile")), num_frames=GREETING)  # draws as many
            yield Viewer(client)
        finally:
            process.terminate()
            process.wait(10.0)


def environment(folder: str) -> dict[str, str]:
    """Variables for a viewer that has its home in `folder`, sends no statistics and draws with the software driver."""
    homes = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR")
    variables = os.environ | dict.fromkeys(homes, folder) | {"CI": "true", "RUST_LOG": LOG}
    if SOFTWARE_DRIVERS:
        variables["VK_ICD_FILENAMES"] = os.pathsep.join(map(str, SOFTWARE_DRIVERS))
    return variables


def connected(process: subprocess.Popen[bytes], port: int) -> ViewerClient | None:
    """The way to the viewer, once it draws; `RuntimeError` if it has ended."""
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
    """Ask until there is something in the answer; `TimeoutError` if there never is."""
    deadline = time.monotonic() + PATIENCE
    while not (answer := ask()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"{must} within {PATIENCE:g} s")
        time.sleep(0.05)
    return answer
