"""Recordings go to files and viewers, whatever the viewers do."""

import signal
import string
import sys
from contextlib import ExitStack, suppress
from pathlib import Path

import psutil
import pytest
import rerun.blueprint as rrb
from rerun.experimental import ViewerClient

from boreprop.errors import InputError
from boreprop_viz import feeder, sinks
from boreprop_viz.picture import environment
from boreprop_viz.ports import LOOPBACK, free_port
from boreprop_viz.sinks import new_recording, open_recording
from viewers import (
    ROWS,
    children_from_now_on,
    draws,
    listens,
    port_of,
    read,
    rerun,
    rows,
    send,
    signals,
    sound,
    stand_in,
    until,
)


def test_a_file_and_a_running_viewer_get_everything(tmp_path: Path) -> None:
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    with rerun("--save", seen) as (_, address):
        with open_recording(save=saved, connect=address) as rec:
            send(rec, range(20))
        assert until(lambda: read(seen) == rows(20))
    assert sound(saved)
    assert read(saved) == rows(20)


@signals
def test_a_file_and_a_new_viewer_get_everything(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    saved, seen = tmp_path / "saved.rrd", tmp_path / "seen.rrd"
    stand_in(f'exec "$rerun" --save {seen} "$@"', monkeypatch, tmp_path)
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
@pytest.mark.parametrize(("harm", "told"), [("SIGKILL", "at ADDRESS has ended"), ("SIGSTOP", "hangs")])
def test_a_viewer_that_dies_or_hangs_does_no_harm(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    harm: str,
    told: str,
) -> None:
    children = children_from_now_on()
    monkeypatch.setattr(feeder, "PATIENCE", 0.5)
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
    told = told.replace("ADDRESS", address)
    assert capsys.readouterr().err == f"warning: the viewer {told}: it may not have received all data\n"


@signals
@pytest.mark.parametrize("command", ["exit 1", "sleep 0.2; kill -9 $$", "exec sleep 1"])
def test_a_new_viewer_that_fails_does_no_harm(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    stand_in(command, monkeypatch, tmp_path)
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


@signals
@pytest.mark.parametrize("busy", [True, False])
def test_a_viewer_that_comes_back_gets_everything(tmp_path: Path, busy: bool) -> None:
    first, second = tmp_path / "first.rrd", tmp_path / "second.rrd"
    with ExitStack() as viewers:
        before, address = viewers.enter_context(rerun("--save", first))
        with open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
            send(rec, range(5))
            until(lambda: read(first) == rows(5))
            before.kill()
            before.wait()
            if busy:
                send(rec, range(5, 10))
            viewers.enter_context(rerun("--save", second, port=port_of(address)))
            assert until(lambda: read(second) == rows(10 if busy else 5))
            send(rec, range(10 if busy else 5, 20))
        assert until(lambda: read(second) == rows(20))


@signals
def test_a_viewer_that_hung_and_was_started_again_gets_everything(tmp_path: Path) -> None:
    first, second = tmp_path / "first.rrd", tmp_path / "second.rrd"
    with ExitStack() as viewers:
        before, address = viewers.enter_context(rerun("--save", first))
        with open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
            send(rec, range(5))
            until(lambda: read(first))
            before.send_signal(signal.SIGSTOP)
            send(rec, range(5, 40))
            before.kill()
            before.wait()
            viewers.enter_context(rerun("--save", second, port=port_of(address)))
        assert until(lambda: read(second) == rows(40))


def test_a_viewer_that_comes_late_gets_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    seen, port = tmp_path / "seen.rrd", free_port()
    address = f"rerun+http://{LOOPBACK}:{port}/proxy"
    with open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
        send(rec, range(3))
        with rerun("--save", seen, port=port):
            assert until(lambda: read(seen) == rows(3))
    assert "is sent everything" in capsys.readouterr().err


@signals
def test_nothing_takes_the_place_of_a_viewer_that_has_died(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    children = children_from_now_on()
    with rerun("--save", tmp_path / "seen.rrd") as (viewer, address):
        port = port_of(address)
        started = feeder.Rerun

        def start(*options: str) -> feeder.Rerun:
            viewer.kill()  # after the look whether it is there
            viewer.wait()
            return started(*options)

        monkeypatch.setattr(feeder, "Rerun", start)
        with open_recording(save=tmp_path / "saved.rrd", connect=address) as rec:
            send(rec, range(1))
            assert until(lambda: viewer.poll() is not None)
            assert until(lambda: not children())
            assert not listens(port)


@signals
@pytest.mark.parametrize(
    ("said", "reason"),
    [
        ("Error: no \\033[31mcolour\\033[0m\\n", "no colour"),
        (
            "\\033[2m2026-01-01T00:00Z\\033[0m \\033[31mERROR\\033[0m \\033[2mre::x\\033[0m:\\033[0m no card\\n",
            "no card",
        ),
        ("Error: os error at /a/b.rs:89: none\\nnote\\n", "os error: none"),
        ("Error: the first\\nError: the last\\n", "the last"),
    ],
)
def test_a_new_viewer_has_the_last_word_on_its_failure(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str], said: str, reason: str
) -> None:
    stand_in(f"printf '{said}' >&2; exit 3", monkeypatch, tmp_path)
    monkeypatch.setenv("DISPLAY", ":0")
    with (
        pytest.raises(InputError, match=rf"the Rerun viewer must start: .*, got exit status 3 \({reason}\)$"),
        open_recording(spawn=True),
    ):
        pass
    with open_recording(save=tmp_path / "saved.rrd", spawn=True) as rec:
        send(rec, range(1))
    [warning] = capsys.readouterr().err.splitlines()
    assert f"ended with exit status 3 ({reason}): " in warning


@signals
def test_of_what_a_viewer_says_little_is_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    stand_in("yes 'a line of a log' | head -n 200000 >&2; echo 'Error: at last' >&2; exit 1", monkeypatch, tmp_path)
    process = feeder.Rerun()
    assert process.stdin
    process.stdin.close()
    process.wait()
    assert process.ending() == "exit status 1 (at last)"
    assert len(process.lines) <= feeder.LAST_LINES


@pytest.mark.skipif(sys.platform != "linux", reason="no such screen")
def test_a_screen_that_cannot_be_used_is_not_called_missing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("WAYLAND_DISPLAY", "none")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    with (
        pytest.raises(InputError, match=r"must start: .*\(.*Could not find wayland compositor\)"),
        open_recording(spawn=True),
    ):
        pass


@pytest.mark.skipif(sys.platform != "linux", reason="a screen cannot be taken away")
def test_without_a_screen_a_new_viewer_is_an_error_if_there_is_no_file(monkeypatch: pytest.MonkeyPatch) -> None:
    children = children_from_now_on()
    for variable in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"):
        monkeypatch.delenv(variable, raising=False)
    with pytest.raises(InputError, match=r"needs a screen: .* \(.*DISPLAY is set\.\)"), open_recording(spawn=True):
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
    children = children_from_now_on()
    saved = tmp_path / "saved.rrd"
    saved.write_text("old")
    with rerun("--serve-grpc") as (viewer, address):
        with suppress(ZeroDivisionError), open_recording(save=saved, connect=address) as rec:
            send(rec, range(3))
            raise ZeroDivisionError
        assert children() == [psutil.Process(viewer.pid)]
    assert saved.read_text() == "old"
    assert list(tmp_path.iterdir()) == [saved]


def test_rerun_takes_any_name_of_an_application_without_a_word(capfd: pytest.CaptureFixture[str]) -> None:
    new_recording(f"{string.punctuation} ηΠ")
    assert capfd.readouterr() == ("", "")


def end(client: ViewerClient) -> int | None:
    """Last row that the viewer has."""
    return max(
        (line.end or 0 for recording in client.get_state().recordings for line in recording.timelines), default=0
    )


@draws
@signals
def test_a_new_viewer_shows_what_there_is_while_the_run_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    children = children_from_now_on()
    for name, value in environment(str(tmp_path)).items():
        monkeypatch.setenv(name, value)
    port = free_port()
    monkeypatch.setattr(sinks, "free_port", lambda: port)
    stand_in('exec "$rerun" --headless "$@"', monkeypatch, tmp_path)
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


@pytest.mark.parametrize("seen", [True, False])
def test_a_viewer_that_was_there_and_is_gone_before_any_data_is_told_of(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], seen: bool
) -> None:
    """Of one that was not there the user knows already."""
    path = tmp_path / "run.rrd"
    path.touch()
    gone = feeder.RunningViewer(path, f"rerun+http://{LOOPBACK}:{free_port()}/proxy", seen)
    gone.finish()
    gone.wait()
    assert capfd.readouterr().err.count("has ended: it may not have received all data") == seen
