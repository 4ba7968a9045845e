"""Recordings go to files and viewers, whatever the viewers do.

Most viewers here are the command `rerun --save`, which takes what a viewer takes and writes it to a file.
"""

import os
import signal
import socket
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from textwrap import dedent
from typing import TypeVar
from urllib.request import urlopen

import numpy as np
import psutil
import pytest
import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import RrdReader
from rerun.experimental import ViewerClient

from boreprop.errors import InputError
from boreprop_viz import sinks
from boreprop_viz.picture import SOFTWARE_DRIVERS, environment
from boreprop_viz.sinks import LOOPBACK, PROGRAM, free_port, open_recording
from places import TESTS

T = TypeVar("T")
Process = subprocess.Popen[bytes]

ROWS = 1000  # in a batch
draws = pytest.mark.skipif(
    not SOFTWARE_DRIVERS, reason="no software Vulkan driver (Debian: mesa-vulkan-drivers and libvulkan1)"
)
signals = pytest.mark.skipif(os.name != "posix", reason="no such signals")


def send(rec: rr.RecordingStream, batches: range) -> None:
    """Log a scalar and 100 points a row, 1.2 MB a batch that do not compress."""
    for batch in batches:
        rows = np.arange(batch * ROWS, (batch + 1) * ROWS)
        index = [rr.TimeColumn("row", sequence=rows)]
        points = np.random.default_rng(batch).random((100 * ROWS, 3), dtype=np.float32)
        rec.send_columns("cloud", index, rr.Points3D.columns(positions=points).partition([100] * ROWS))
        rec.send_columns("row", index, rr.Scalars.columns(scalars=rows.astype(float)))


def read(path: Path) -> list[float]:
    """The scalars in a recording, in their order; those so far, if it is still being written."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="RRD file has no footer")
        try:
            stream = RrdReader(path).stream()
        except (ValueError, RuntimeError):  # no recording yet, half a chunk
            return []
    chunks = stream.filter(content="/row", components="Scalars:scalars", has_timeline="row")
    batches = [chunk.to_record_batch() for chunk in chunks]
    return sorted(value for batch in batches for [value] in batch.column("Scalars:scalars").to_pylist())


def rows(batches: int) -> list[float]:
    """What there is to read after so many batches."""
    return [float(row) for row in range(batches * ROWS)]


def sound(path: Path) -> bool:
    """Whether Rerun itself finds nothing wrong in a file, not even that its end is missing."""
    return subprocess.run([PROGRAM, "rrd", "verify", path], capture_output=True, check=False).returncode == 0


def until(ask: Callable[[], T | None]) -> T:
    """Ask until there is something in the answer."""
    for _ in range(600):
        if answer := ask():
            return answer
        time.sleep(0.05)
    raise TimeoutError


def listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex((LOOPBACK, port)) == 0


@contextmanager
def rerun(*options: str | Path, env: dict[str, str] | None = None) -> Iterator[tuple[Process, str]]:
    """Run a viewer that is there already; yields its process and its address."""
    port = free_port()
    where = ["--bind", LOOPBACK, "--port", str(port)]
    process = subprocess.Popen([PROGRAM, *where, *options], stderr=subprocess.DEVNULL, env=env)
    try:
        until(lambda: listens(port))
        yield process, f"rerun+http://{LOOPBACK}:{port}/proxy"
    finally:
        process.kill()
        process.wait()


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[str], None]:
    """Let a command, which is given rerun's path and options, be the viewer of `spawn` and `serve`."""

    def replace(command: str) -> None:
        script = tmp_path / "viewer"
        script.write_text(f"#!/bin/sh\nrerun='{PROGRAM}'\n{command}\n")
        script.chmod(0o755)
        monkeypatch.setattr(sinks, "PROGRAM", str(script))

    return replace


@pytest.fixture(autouse=True)
def others() -> Iterator[None]:
    """Processes that earlier tests have left to help multiprocessing are none of what is tested here."""
    OTHERS[:] = psutil.Process().children(recursive=True)
    yield
    OTHERS.clear()


OTHERS: list[psutil.Process] = []


def children() -> list[psutil.Process]:
    return [process for process in psutil.Process().children(recursive=True) if process not in OTHERS]


def test_a_file_and_a_running_viewer_get_everything(tmp_path: Path) -> None:
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    with rerun("--save", seen) as (_, address):
        with open_recording(save=saved, connect=address) as rec:
            send(rec, range(20))
        assert until(lambda: read(seen) == rows(20))
    assert sound(saved)
    assert read(saved) == rows(20)


@signals
def test_a_file_and_a_new_viewer_get_everything(tmp_path: Path, stand_in: Callable[[str], None]) -> None:
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    stand_in(f'exec "$rerun" --save {seen} "$@"')
    with open_recording(save=saved, spawn=True) as rec:
        send(rec, range(20))
    assert read(saved) == read(seen) == rows(20)


def test_without_a_file_the_viewer_gets_everything_and_nothing_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen, scratch = tmp_path / "seen.rrd", tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    with rerun("--save", seen) as (_, address):
        with open_recording(connect=address) as rec:
            send(rec, range(3))
            assert list(scratch.iterdir())
        assert until(lambda: read(seen) == rows(3))
    assert not list(scratch.iterdir())


def test_the_viewer_is_fed_while_the_run_goes_on(tmp_path: Path) -> None:
    seen = tmp_path / "seen.rrd"
    with rerun("--save", seen) as (_, address), open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
        send(rec, range(3))
        assert until(lambda: read(seen) == rows(3))


@signals
@pytest.mark.parametrize(("harm", "told"), [("SIGKILL", "ended with exit status 1"), ("SIGSTOP", "hangs")])
def test_a_viewer_that_dies_or_hangs_does_no_harm(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], harm: str, told: str
) -> None:
    monkeypatch.setattr(sinks, "PATIENCE", 0.5)
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    with rerun("--save", seen) as (viewer, address):
        with open_recording(save=saved, connect=address) as rec:
            send(rec, range(5))
            until(lambda: read(seen))
            viewer.send_signal(signal.Signals[harm])
            send(rec, range(5, 20))
        assert children() == [psutil.Process(viewer.pid)]
    assert sound(saved)
    assert read(saved) == rows(20)
    assert capsys.readouterr().err == f"warning: the viewer {told}: it may not have received all data\n"


@signals
@pytest.mark.parametrize("command", ["exit 1", "sleep 0.2; kill -9 $$", "exec sleep 1"])
def test_a_new_viewer_that_fails_does_no_harm(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], stand_in: Callable[[str], None], command: str
) -> None:
    stand_in(command)
    saved = tmp_path / "saved.rrd"
    with open_recording(save=saved, spawn=True) as rec:
        send(rec, range(5))
    assert read(saved) == rows(5)
    [warning] = capsys.readouterr().err.splitlines()
    assert warning.startswith("warning: the viewer ended with exit status ")


def test_a_viewer_that_is_not_there_is_missed_only_without_a_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    address = f"rerun+http://{LOOPBACK}:{free_port()}/proxy"
    with (
        pytest.raises(ConnectionError, match=r"the viewer must listen at .*, got 'rerun"),
        open_recording(connect=address),
    ):
        pass
    with open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
        send(rec, range(1))
    assert read(tmp_path / "saved.rrd") == rows(1)
    [warning] = capsys.readouterr().err.splitlines()
    assert warning.startswith("warning: the viewer must listen at ")


@pytest.mark.skipif(sys.platform != "linux", reason="a screen cannot be taken away")
def test_without_a_screen_a_new_viewer_is_an_error_if_there_is_no_file(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
        monkeypatch.delenv(variable, raising=False)
    with pytest.raises(InputError, match="needs a screen"), open_recording(spawn=True):
        pass
    assert not children()


@pytest.mark.parametrize(
    "address",
    [
        "here",
        "http://127.0.0.1:9876/proxy",
        "rerun+http://127.0.0.1:1",
        "rerun+http:///proxy",
        "rerun+http://[::1/proxy",
        "rerun+http://127.0.0.1:x/proxy",
    ],
)
def test_an_address_must_be_one_even_if_there_is_a_file(tmp_path: Path, address: str) -> None:
    with (
        pytest.raises(InputError, match=r"rerun\+http://HOST:PORT/proxy, got "),
        open_recording(save=tmp_path / "saved.rrd", connect=address),
    ):
        pass
    assert not list(tmp_path.iterdir())


def test_an_exception_leaves_the_old_file_and_no_viewer(tmp_path: Path) -> None:
    saved = tmp_path / "saved.rrd"
    saved.write_text("old")
    with rerun("--serve-grpc") as (viewer, address):
        with suppress(ZeroDivisionError), open_recording(save=saved, connect=address) as rec:
            send(rec, range(3))
            raise ZeroDivisionError
        assert children() == [psutil.Process(viewer.pid)]
    assert saved.read_text() == "old"
    assert list(tmp_path.iterdir()) == [saved]


def script(body: str, env: dict[str, str] | None = None) -> Process:
    """Start another Python, in a process group of its own as from a terminal, that has `send` and `open_recording`."""
    top = f"import sys\nsys.path.append({str(TESTS)!r})\n"
    top += "from boreprop_viz.sinks import open_recording\nfrom test_viz_sinks import send\n"
    return subprocess.Popen(
        [sys.executable, "-c", top + dedent(body)],
        cwd=Path(__file__).parent,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        env=env,
    )


@signals
@pytest.mark.parametrize("viewed", [False, True])
def test_control_c_leaves_a_whole_file(tmp_path: Path, viewed: bool) -> None:
    saved = tmp_path / "saved.rrd"
    with rerun("--serve-grpc") as (_, address):
        run = script(f"""
            with open_recording(save={str(saved)!r}, connect={address if viewed else None!r}) as rec:
                send(rec, range(5))
                print("ready", flush=True)
                send(rec, range(5, 1_000_000))
        """)
        assert run.stdout
        run.stdout.readline()
        os.killpg(run.pid, signal.SIGINT)
        _, errors = run.communicate(timeout=60.0)
    assert run.returncode == -signal.SIGINT, errors
    assert errors.splitlines()[-1] == b"KeyboardInterrupt"
    assert sound(saved)
    found = read(saved)
    assert found[: 5 * ROWS] == rows(5)
    assert np.all(np.diff(found) == 1.0)
    assert list(tmp_path.iterdir()) == [saved]


@signals
def test_control_c_while_a_viewer_starts_leaves_no_viewer(
    monkeypatch: pytest.MonkeyPatch, stand_in: Callable[[str], None]
) -> None:
    def interrupt(seconds: float) -> None:
        assert children()
        raise KeyboardInterrupt

    stand_in("exec sleep 60")
    monkeypatch.setattr(sinks, "sleep", interrupt)
    with pytest.raises(KeyboardInterrupt), open_recording(spawn=True):
        pass
    assert not children()


@pytest.mark.skipif(sys.platform != "linux", reason="no such limit")
def test_a_full_disk_is_an_error_and_leaves_the_old_file(tmp_path: Path) -> None:
    saved = tmp_path / "saved.rrd"
    saved.write_text("old")
    run = script(f"""
        import os, resource, signal
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (3_000_000, 3_000_000))
        try:
            with open_recording(save={str(saved)!r}) as rec:
                send(rec, range(5))
        except OSError as error:
            print(type(error).__name__, flush=True)
            os._exit(0)  # Rerun's own end of the process may hang where its writer has died
    """)
    try:
        said, _ = run.communicate(timeout=60.0)
    finally:
        run.kill()
    assert said == b"OSError\n"
    assert saved.read_text() == "old"
    assert list(tmp_path.iterdir()) == [saved]


@pytest.fixture
def served(tmp_path: Path) -> Iterator[tuple[Process, str]]:
    """A recording that is served in the browser until Ctrl-C, and the address that this prints."""
    run = script(
        f"""
            with open_recording(save={str(tmp_path / "saved.rrd")!r}, serve=True) as rec:
                send(rec, range(5))
            print("the end", flush=True)
        """,
        env=os.environ | {"BROWSER": "true"},
    )
    try:
        assert run.stdout
        yield run, run.stdout.readline().decode().split()[-1]
    finally:
        if run.poll() is None:
            os.killpg(run.pid, signal.SIGKILL)
        run.communicate()


@signals
def test_a_late_viewer_of_what_is_served_gets_everything(tmp_path: Path, served: tuple[Process, str]) -> None:
    _, page = served
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    until(saved.exists)
    assert b"rerun" in urlopen(page).read().lower()
    address = page.partition("?url=")[2]
    with rerun("--save", seen, address.replace("%3A", ":").replace("%2F", "/").replace("%2B", "+")) as _:
        assert until(lambda: read(seen) == rows(5))


@signals
def test_serving_ends_quietly_with_control_c(tmp_path: Path, served: tuple[Process, str]) -> None:
    run, _ = served
    until((tmp_path / "saved.rrd").exists)
    os.killpg(run.pid, signal.SIGINT)
    output, errors = run.communicate(timeout=60.0)
    assert run.returncode == 0
    assert output.splitlines()[-1] == b"the end"
    assert not errors


@signals
@pytest.mark.parametrize("spawn", [True, False])
def test_a_new_viewer_listens_on_this_machine_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stand_in: Callable[[str], None], spawn: bool
) -> None:
    monkeypatch.setenv("BROWSER", "true")
    if spawn:
        stand_in('exec "$rerun" --serve-grpc "$@"')
    ports = 1 if spawn else 2

    def listening() -> set[str]:
        found = [
            connection.laddr.ip
            for process in children()
            for connection in process.net_connections()
            if connection.status == psutil.CONN_LISTEN
        ]
        return set(found) if len(found) == ports else set()

    with suppress(KeyboardInterrupt), open_recording(save=tmp_path / "saved.rrd", spawn=spawn, serve=not spawn) as rec:
        send(rec, range(1))
        assert until(listening) == {"127.0.0.1"}
        raise KeyboardInterrupt


@signals
@pytest.mark.slow
def test_memory_is_bounded_and_the_run_goes_on_when_the_viewer_hangs(tmp_path: Path) -> None:
    def peak(batches: int) -> float:
        with rerun("--serve-grpc") as (viewer, address):
            run = script(f"""
                import resource, sys
                from boreprop_viz import sinks
                sinks.PATIENCE = 0.5
                with open_recording(save={str(tmp_path / "saved.rrd")!r}, connect={address!r}) as rec:
                    send(rec, range(1))
                    print("ready", flush=True)
                    sys.stdin.readline()
                    for batch in range(1, {batches}):
                        send(rec, range(batch, batch + 1))
                        rec.flush()  # Rerun queues some 100 MB for the disk
                print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)
            """)
            assert run.stdout
            run.stdout.readline()
            viewer.send_signal(signal.SIGSTOP)
            output, errors = run.communicate(b"\n", timeout=300.0)
        assert b"the viewer hangs" in errors
        return float(output)

    few, many = peak(50), peak(400)
    assert (tmp_path / "saved.rrd").stat().st_size > 450e6
    assert many < few + 20.0  # MB


def end(client: ViewerClient) -> int | None:
    """Last row that the viewer has."""
    return max(
        (line.end or 0 for recording in client.get_state().recordings for line in recording.timelines), default=0
    )


@draws
@signals
def test_a_new_viewer_shows_what_there_is_while_the_run_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stand_in: Callable[[str], None]
) -> None:
    for name, value in environment(str(tmp_path)).items():
        monkeypatch.setenv(name, value)
    port = free_port()
    monkeypatch.setattr(sinks, "free_port", lambda: port)
    stand_in('exec "$rerun" --headless "$@"')
    with open_recording(spawn=True) as rec:
        client = ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")
        send(rec, range(1))
        assert until(lambda: end(client) == ROWS - 1)
        send(rec, range(1, 2))
        assert until(lambda: end(client) == 2 * ROWS - 1)
        [viewer] = children()
        viewer.terminate()


@draws
def test_the_blueprint_of_the_last_recording_is_the_one_shown(tmp_path: Path) -> None:
    def show(name: str, address: str) -> None:
        with open_recording(connect=address) as rec:
            rec.send_blueprint(rrb.Blueprint(rrb.TimeSeriesView(origin="/", name=name)))
            send(rec, range(1))

    with rerun("--headless", env=environment(str(tmp_path))) as (_, address):
        client = ViewerClient.connect(address)
        show("first", address)
        assert until(lambda: [view.name for view in client.get_state().views] == ["first"])
        show("second", address)
        assert until(lambda: [view.name for view in client.get_state().views] == ["second"])
