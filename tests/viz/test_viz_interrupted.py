"""What is left of a recording and its viewers by Ctrl-C, a full disk, or a viewer that hangs for long."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from textwrap import dedent
from urllib.request import urlopen

import numpy as np
import psutil
import pytest

from boreprop.case.case import Case
from boreprop.run.results import write_trajectory
from boreprop.run.simulate import simulate
from boreprop_fmu.pack.build import build_fmu
from boreprop_viz import feeder
from boreprop_viz.sinks import open_recording
from forking import Process
from viewers import (
    ROWS,
    boreprop_view,
    children_from_now_on,
    read,
    rerun,
    rows,
    script,
    send,
    signals,
    sound,
    stand_in,
    until,
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
        _, errors = run.communicate()
    assert run.returncode == -signal.SIGINT, errors
    assert errors.splitlines()[-1] == b"KeyboardInterrupt"
    assert sound(saved)
    found = read(saved)
    assert found[: 5 * ROWS] == rows(5)
    assert np.all(np.diff(found) == 1.0)
    assert list(tmp_path.iterdir()) == [saved]


@signals
def test_control_c_while_a_viewer_starts_leaves_no_viewer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    children = children_from_now_on()

    def interrupt(seconds: float) -> None:
        assert children()
        raise KeyboardInterrupt

    stand_in("exec sleep 60", monkeypatch, tmp_path)
    monkeypatch.setattr(feeder, "sleep", interrupt)
    with pytest.raises(KeyboardInterrupt), open_recording(spawn=True):
        pass
    assert not children()


@pytest.mark.skipif(sys.platform != "linux", reason="no such limit")
def test_a_full_disk_is_an_error_and_leaves_the_old_file(tmp_path: Path) -> None:
    saved = tmp_path / "saved.rrd"
    saved.write_text("old")
    run = script(f"""
        import os, resource, signal
        from boreprop_viz import sinks
        sinks.PATIENCE = 2.0
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
        said, _ = run.communicate()
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
    address = page.partition("?url=")[2].partition("&")[0]
    with rerun("--save", seen, address.replace("%3A", ":").replace("%2F", "/").replace("%2B", "+")) as _:
        assert until(lambda: read(seen) == rows(5))


@pytest.fixture(scope="module")
def run_file(tmp_path_factory: pytest.TempPathFactory, case: Case) -> Path:
    path = tmp_path_factory.mktemp("run") / "run.csv"
    write_trajectory(simulate(case, length=5.0), path)
    return path


@signals
@pytest.mark.parametrize("ending", ["SIGTERM", "SIGHUP"])
@pytest.mark.parametrize("viewer", ["--serve", "--spawn"])
def test_the_command_takes_its_viewer_with_it(tmp_path: Path, run_file: Path, viewer: str, ending: str) -> None:
    saved = tmp_path / "saved.rrd"
    command = boreprop_view(run_file, viewer, "--save", saved, folder=tmp_path)
    until(saved.exists)
    [child] = psutil.Process(command.pid).children()
    number = signal.Signals[ending]
    command.send_signal(number)
    _, errors = command.communicate()
    assert (command.returncode, errors) == (-number, b"")
    assert not child.is_running()
    assert sound(saved)


@signals
@pytest.mark.parametrize("ending", ["SIGTERM", "SIGHUP"])
@pytest.mark.parametrize("viewer", ["--serve", "--spawn"])
def test_the_command_keeps_the_file_when_it_is_ended_while_it_draws(
    tmp_path: Path, case: Case, viewer: str, ending: str
) -> None:
    saved, fmu = tmp_path / "saved.rrd", tmp_path / "Borehole.fmu"
    build_fmu(case, fmu, runtime="python")
    command = boreprop_view(fmu, viewer, "--save", saved, "--step", "0.01", "--stop", "1000", folder=tmp_path)
    until(lambda: [draft for draft in tmp_path.glob(".*.saved.rrd") if draft.stat().st_size > 100_000])
    [child] = psutil.Process(command.pid).children()
    number = signal.Signals[ending]
    command.send_signal(number)
    _, errors = command.communicate()
    assert (command.returncode, errors) == (-number, b"")
    assert not child.is_running()
    assert sound(saved)
    assert not list(tmp_path.glob(".*.saved.rrd"))


@signals
def test_a_signal_that_was_ignored_before_is_ignored(tmp_path: Path, run_file: Path) -> None:
    ignoring = "signal.signal(signal.SIGHUP, signal.SIG_IGN)"
    saved = tmp_path / "saved.rrd"
    command = boreprop_view(run_file, "--serve", "--save", saved, before=ignoring, folder=tmp_path)
    until(saved.exists)
    command.send_signal(signal.SIGHUP)
    command.send_signal(signal.SIGTERM)  # which comes first if both are heeded
    command.communicate()
    assert command.returncode == -signal.SIGTERM


@signals
def test_importing_the_viewer_leaves_all_signals_alone() -> None:
    code = """
        import signal
        before = [signal.getsignal(number) for number in signal.valid_signals()]
        from boreprop_viz import cli, live, record, show
        print(before == [signal.getsignal(number) for number in signal.valid_signals()])
    """
    done = subprocess.run([sys.executable, "-c", dedent(code)], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


@signals
def test_serving_ends_quietly_with_control_c(tmp_path: Path, served: tuple[Process, str]) -> None:
    run, _ = served
    until((tmp_path / "saved.rrd").exists)
    os.killpg(run.pid, signal.SIGINT)
    output, errors = run.communicate()
    assert run.returncode == 0
    assert output.splitlines()[-1] == b"the end"
    assert not errors


@signals
@pytest.mark.parametrize("spawn", [True, False])
def test_a_new_viewer_listens_on_this_machine_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, spawn: bool
) -> None:
    children = children_from_now_on()
    monkeypatch.setenv("BROWSER", "true")
    if spawn:
        stand_in('exec "$rerun" --serve-grpc "$@"', monkeypatch, tmp_path)
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
                from boreprop_viz import feeder
                feeder.PATIENCE = 0.5
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
            output, errors = run.communicate(b"\n")
        assert b"the viewer hangs" in errors
        return float(output)

    few, many = peak(25), peak(100)
    assert (tmp_path / "saved.rrd").stat().st_size > 112e6
    assert many < few + 20.0  # MB
