"""The wheel for this machine and the source distribution, installed afresh: what then works, with which compiler."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Callable
from pathlib import Path

import pytest

from boreprop.case.file import load_case
from boreprop.kernel.compiler import PLATFORMS, host_platform
from boreprop.run.results import read_trajectory
from boreprop.run.simulate import simulate
from places import EXAMPLES

COMMANDS = ("boreprop", "boreprop-fmu", "boreprop-view")
CASE = EXAMPLES / "paper_case.toml"
SUFFIX = ".exe" if os.name == "nt" else ""

Run = Callable[..., str]


def run(*words: str | Path, **settings: str) -> str:
    """What a command prints on stdout; nothing of what is set for this Python or for compilers is handed on."""
    kept = {name: value for name, value in os.environ.items() if name not in ("CC", "CFLAGS", "PYTHONPATH")}
    done = subprocess.run(
        [*map(str, words)], env={**kept, **settings}, capture_output=True, text=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def environment(folder: Path) -> Path:
    """A new environment: the folder of its programs."""
    venv.create(folder, with_pip=True)
    return folder / ("Scripts" if os.name == "nt" else "bin")


def install(folder: Path, house: Path, *words: str | Path, **settings: str) -> None:
    """Install into an environment, from the house only."""
    run(folder / "python", "-m", "pip", "install", "-q", "--no-compile", "--no-index", "-f", house, *words, **settings)


@pytest.fixture(scope="module")
def version(archives: Path) -> str:
    (sdist,) = archives.glob("*.tar.gz")
    return sdist.name.removeprefix("boreprop-").removesuffix(".tar.gz")


@pytest.fixture(scope="module")
def house(archives: Path, version: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel for this machine and all that it depends on, and what builds the source distribution."""
    folder: Path = tmp_path_factory.mktemp("house")
    run(sys.executable, "-m", "pip", "download", "-q", "-f", archives, "-d", folder, "--only-binary", ":all:",
        f"boreprop[all]=={version}", "hatchling")  # fmt: skip
    return folder


@pytest.fixture(scope="module")
def programs(house: Path, version: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with all of boreprop from its wheel, without ziglang."""
    folder = environment(tmp_path_factory.mktemp("installed") / "env")
    install(folder, house, f"boreprop[all]=={version}")
    return folder


@pytest.fixture
def command(programs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run a program of that environment, in a new folder. No compiler is to be found."""
    monkeypatch.chdir(tmp_path)
    return lambda name, *words: run(programs / name, *words, PATH=str(programs))


def test_pip_takes_the_wheel_for_this_machine(house: Path) -> None:
    (wheel,) = house.glob("boreprop-*.whl")
    assert wheel.name.endswith(f"-{PLATFORMS[str(host_platform())].tag}.whl")


def test_it_brings_no_compiler_and_finds_none(command: Run) -> None:
    looks = "import shutil; from importlib.util import find_spec; print(find_spec('ziglang'), shutil.which('cc'))"
    assert command("python", "-c", looks).split() == ["None", "None"]


@pytest.mark.parametrize("name", COMMANDS)
def test_it_has_the_commands(command: Run, name: str) -> None:
    assert f"Usage: {name}" in command(name, "--help")


def test_its_engine_is_native_and_drills_as_python_does(command: Run) -> None:
    assert "native" in command("boreprop", "simulate", CASE, "--output", "run.csv", "--length", "50")
    got = read_trajectory(Path("run.csv"))
    expected = simulate(load_case(CASE), sample_interval=0.1, length=50.0, engine="python")
    assert got["bit_inclination"] == pytest.approx(expected["bit_inclination"], rel=1e-9, abs=1e-11)


def test_it_packs_fmus_for_every_platform_and_runs_one(command: Run) -> None:
    command("boreprop-fmu", "build", CASE, "--output", "a.fmu", "--platforms", ",".join(PLATFORMS))
    command("boreprop-fmu", "run", "a.fmu", "--output", "run.csv", "--stop", "50")
    listing = command("python", "-m", "zipfile", "-l", "a.fmu")
    assert [name for name in PLATFORMS if f"binaries/{name}/Borehole{PLATFORMS[name].suffix}" not in listing] == []
    expected = simulate(load_case(CASE), sample_interval=0.1, length=50.0, engine="python")
    assert read_trajectory(Path("run.csv"))["bit_inclination"] == pytest.approx(
        expected["bit_inclination"], rel=1e-9, abs=1e-11
    )


def test_it_packs_an_fmu_in_python_and_draws(command: Run) -> None:
    command("boreprop-fmu", "build", CASE, "--output", "a.fmu", "--runtime", "python")
    command("boreprop-fmu", "run", "a.fmu", "--output", "run.csv", "--stop", "10")
    command("boreprop-view", "run.csv", "--save", "run.rrd")
    command("boreprop", "steering", CASE, "--output", "steering.png")
    assert all(Path(name).stat().st_size > 10_000 for name in ("run.rrd", "steering.png"))


def test_without_extras_it_simulates(house: Path, version: str, tmp_path: Path) -> None:
    folder = environment(tmp_path / "env")
    install(folder, house, f"boreprop=={version}")
    assert "native" in run(
        folder / "boreprop", "simulate", CASE, "--output", tmp_path / "run.csv", "--length", "5", PATH=str(folder)
    )


def test_uv_installs_the_commands_as_a_tool(house: Path, version: str, tmp_path: Path) -> None:
    pytest.importorskip("uv")
    uv = Path(sysconfig.get_path("scripts"), f"uv{SUFFIX}")
    places = {f"UV_{name}": str(tmp_path / name) for name in ("TOOL_DIR", "TOOL_BIN_DIR", "CACHE_DIR")}
    words = ("--no-index", "-f", house, "--python", sys.executable, f"boreprop[all]=={version}")
    run(uv, "tool", "install", "--quiet", *words, **places)
    for name in COMMANDS:
        assert f"Usage: {name}" in run(tmp_path / "TOOL_BIN_DIR" / name, "--help")


@pytest.mark.parametrize("compiler", ["a compiler", "ziglang", "neither"])
def test_the_source_distribution_installs_with(compiler: str, archives: Path, house: Path, tmp_path: Path) -> None:
    if compiler == "a compiler" and not (shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")):
        pytest.skip("no C compiler")
    (sdist,) = archives.glob("*.tar.gz")
    folder = environment(tmp_path / "env")
    if compiler == "ziglang":
        zig = pytest.importorskip("ziglang")
        (site,) = (tmp_path / "env").rglob("site-packages")
        (site / "ziglang").symlink_to(Path(zig.__file__).parent)
    path = os.environ["PATH"] if compiler == "a compiler" else str(folder)
    install(folder, house, "--no-deps", sdist, PATH=path)
    others = {"PYTHONPATH": sysconfig.get_path("purelib"), "PATH": str(folder)}  # all packages but boreprop itself
    words = ("simulate", CASE, "--output", tmp_path / "run.csv", "--length", "5")
    engine = "python" if compiler == "neither" else "native"
    assert engine in run(folder / "boreprop", *words, **others)
    fmu = tmp_path / "a.fmu"
    run(folder / "boreprop-fmu", "build", CASE, "--output", fmu, **others)
    packed = run(folder / "python", "-m", "zipfile", "-l", fmu)
    assert ("sources/fmi2.c" in packed) == (compiler != "neither")
