"""Where new viewers listen: at the ports asked for, or at free ones next to each other."""

import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

from boreprop.case.case import Case
from boreprop.errors import InputError
from boreprop.run.simulate import simulate
from boreprop_viz.ports import LOOPBACK, check_free, free_port, port_pair
from boreprop_viz.record import record
from boreprop_viz.sinks import open_recording
from conftest import Command, assert_refused
from viewers import listens, port_of, send, signals, stand_in, until


@pytest.fixture
def taken() -> Iterator[int]:
    """A port at which another program listens."""
    with socket.socket() as other:
        other.bind((LOOPBACK, 0))
        other.listen()
        yield other.getsockname()[1]


def can_be_bound(port: int) -> bool:
    with socket.socket() as probe, suppress(OSError):
        probe.bind((LOOPBACK, port))
        return True
    return False


def test_two_ports_next_to_each_other_are_free() -> None:
    page, data = port_pair(None)
    assert data == page + 1
    assert can_be_bound(page)
    assert can_be_bound(data)


def test_the_pair_that_is_asked_for_is_used_if_it_is_free(taken: int) -> None:
    first, _ = port_pair(None)
    assert port_pair(first) == (first, first + 1)
    for first in (taken, taken - 1):
        with pytest.raises(InputError, match=rf"^--port: ports {first} and {first + 1} must be free, got {taken}: "):
            port_pair(first)


@pytest.mark.parametrize("port", [-1, 0, 65536, 10**9])
def test_a_port_must_be_one(port: int) -> None:
    with pytest.raises(InputError, match=rf"^--port: must be 1 to 65535, got {port}$"):
        check_free(port)


def test_the_last_port_leaves_none_for_the_data() -> None:
    with pytest.raises(InputError, match=r"got 65536$"):
        port_pair(65535)


@signals
def test_a_port_whose_connections_are_just_closing_is_free() -> None:
    with socket.socket() as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as Rerun does
        server.bind((LOOPBACK, 0))
        server.listen()
        port = server.getsockname()[1]
        with socket.create_connection((LOOPBACK, port)):
            server.accept()[0].close()  # the server closes first, so that the connection remains for a while
    assert not can_be_bound(port)
    check_free(port)


@signals
@pytest.mark.parametrize("given", [True, False])
def test_the_page_and_the_data_are_served_next_to_each_other(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], given: bool
) -> None:
    monkeypatch.setenv("BROWSER", "true")
    asked = port_pair(None)[0] if given else None
    with suppress(KeyboardInterrupt), open_recording(serve=True, port=asked) as rec:
        send(rec, range(1))
        url = urlsplit(capsys.readouterr().out.split()[-1])
        page, data = url.port or 0, port_of(parse_qs(url.query)["url"][0])
        assert data == page + 1
        assert page == asked or not given
        assert until(lambda: listens(page) and listens(data))
        raise KeyboardInterrupt


@signals
def test_a_new_window_takes_data_at_the_port_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in('exec "$rerun" --serve-grpc "$@"', monkeypatch, tmp_path)
    port = free_port()
    with suppress(KeyboardInterrupt), open_recording(save=tmp_path / "saved.rrd", spawn=True, port=port):
        assert until(lambda: listens(port))
        raise KeyboardInterrupt


@signals
def test_what_is_served_may_take_half_of_the_memory_and_nothing_is_told_to_rerun_about_its_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = tmp_path / "told"
    stand_in(f'echo "$@" > {told}; echo "CI=$CI" >> {told}; cat > /dev/null', monkeypatch, tmp_path)
    with open_recording(serve=True) as rec:
        send(rec, range(1))
    options, statistics = told.read_text().splitlines()
    assert "--server-memory-limit 50% " in options
    assert statistics == "CI=true"


def test_a_port_needs_a_viewer_of_our_own(case: Case, tmp_path: Path) -> None:
    run = simulate(case, length=1.0)
    with pytest.raises(InputError, match=r"^port: must be given with spawn or serve, got 9000 without"):
        record(run, save=tmp_path / "saved.rrd", port=9000)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("others", [(), ("--save", "x.rrd"), ("--connect", "rerun+http://127.0.0.1:1/proxy")])
def test_the_command_refuses_a_port_without_a_viewer_of_its_own(command_here: Command, others: tuple[str, ...]) -> None:
    assert_refused(command_here("boreprop-view", "run.csv", "--port", "9000", *others), "--port", "--serve", "--spawn")


@pytest.mark.parametrize("viewer", ["--serve", "--spawn"])
def test_the_command_refuses_a_port_in_use_before_it_simulates(
    command_here: Command, viewer: str, taken: int, tmp_path: Path
) -> None:
    (tmp_path / "none.toml").write_text("not a case")
    assert_refused(command_here("boreprop-view", "none.toml", viewer, "--port", str(taken)), "--port", str(taken))
