"""What several test files need."""

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from hashlib import sha256
from importlib.metadata import entry_points
from pathlib import Path

import hypothesis
import pytest
from hypothesis.internal.conjecture import providers

from boreprop.case.case import Case
from boreprop.case.file import load_case
from boreprop.kernel import binding, compiler
from boreprop.kernel.compiler import NoCompilerError, build_library, host_platform
from boreprop_fmu.native.binaries import BINARIES, LAWS, binary_path, build_binaries, compile_binary, is_compiled
from boreprop_fmu.pack.build import build_fmu
from flavours import NATIVE, PYTHON, Flavour
from forking import run_script
from places import EXAMPLES

# The suite tries the same examples everywhere, on machines slow and fast; `make soak` tries new ones. Hypothesis would
# also draw numbers that it finds in the modules that happen to be loaded.
SUITE = hypothesis.settings(
    database=None, deadline=None, derandomize=True, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.register_profile("suite", SUITE)
hypothesis.settings.register_profile("soak", SUITE, derandomize=False)
hypothesis.settings.load_profile("suite")
providers._get_local_constants = lambda: providers._local_constants

pytest_plugins = ["built_wheels", "studies", "steering_cases", "native_fmu", "numbered_runs"]  # their fixtures

# what a terminal or a server that runs the suite sets would change what commands print
for name in ("CI", "COLUMNS", "FORCE_COLOR", "GITHUB_ACTIONS", "LINES", "NO_COLOR", "PY_COLORS", "TTY_COMPATIBLE"):
    os.environ.pop(name, None)
os.environ.pop("SOURCE_DATE_EPOCH", None)  # and what an FMU says of its date
os.environ["OPENBLAS_NUM_THREADS"] = "1"  # of the workers, each of which has a core: further threads would only wait


Command = Callable[..., subprocess.CompletedProcess[str]]
Pack = Callable[[Case, Flavour], Path]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--wheels", metavar="FOLDER", help="check what build_wheels.py has made there (tests/wheels)")
    parser.addoption(
        "--own-compiler", action="store_true", help="native FMUs in the plane by this machine's own compiler"
    )


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Half as many again as there are cores: what tests wait for, other processes mostly, leaves cores idle."""
    return -(-3 * (os.cpu_count() or 1) // 2)


@pytest.fixture(scope="session")
def paper_case() -> Path:
    """The case file of the paper's case."""
    return EXAMPLES / "paper_case.toml"


@pytest.fixture(scope="session")
def paper_text(paper_case: Path) -> str:
    """What is in it, without the comments (so that a text replaced is a value replaced)."""
    lines = paper_case.read_text(encoding="utf-8").splitlines()
    return "\n".join(line.partition("#")[0].rstrip() for line in lines)


@pytest.fixture(scope="session")
def case(paper_case: Path) -> Case:
    """The paper's case, from its file."""
    return load_case(paper_case)


@pytest.fixture(scope="session")
def kernel() -> None:
    """The native engine, built from the sources as they are now. Without a compiler tests of it are skipped."""
    if not binding.available():
        try:
            build_library()
        except NoCompilerError as error:
            pytest.skip(str(error))
        binding.library.cache_clear()


@pytest.fixture(scope="session", params=["python", "native"])
def engine(request: pytest.FixtureRequest) -> str:
    """Either engine, one after the other."""
    if request.param == "native":
        request.getfixturevalue("kernel")
    return str(request.param)


@pytest.fixture(scope="session")
def flavour(request: pytest.FixtureRequest) -> Flavour:
    """Which FMU a test asks for; both, one after the other, with `both_flavours`."""
    chosen: Flavour = getattr(request, "param", PYTHON)
    return chosen


@pytest.fixture(scope="session")
def binaries(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the binaries of native FMUs, with that for this machine from the sources as they are now."""
    host = host_platform()
    if host is None:
        pytest.skip("no FMU has a binary for this machine")
    if request.config.getoption("--own-compiler"):
        folder = tmp_path_factory.mktemp("binaries")
        compile_binary(binary_path(host, folder), None)
        return folder
    if not all(is_compiled(host, in_space=in_space) for in_space in LAWS):
        try:
            list(build_binaries())
        except NoCompilerError as error:
            pytest.skip(str(error))
    return BINARIES


@pytest.fixture
def compiling_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is compiled is not optimized: for tests of what is in a library, not of what it computes."""
    monkeypatch.setattr(compiler, "FLAGS", tuple("-O0" if flag == "-O3" else flag for flag in compiler.FLAGS))


@pytest.fixture(scope="session")
def pack(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Pack:
    """The FMU of a case, built once: ``pack(case, flavour)``. Without a compiler tests of native ones are skipped."""

    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent  # the workers share what they build

    def packed(case: Case, flavour: Flavour) -> Path:
        digest = sha256(repr(case).encode()).hexdigest()[:16]
        fmu = folder / f"{flavour}_{digest}" / "Borehole.fmu"
        if not fmu.exists():
            fmu.parent.mkdir(exist_ok=True)
            binaries = request.getfixturevalue("binaries") if flavour is NATIVE else BINARIES
            build_fmu(case, fmu, runtime=flavour.runtime, binaries=binaries)
        return fmu

    return packed


@pytest.fixture(scope="session")
def fmu(case: Case, flavour: Flavour, pack: Pack) -> Path:
    """The FMU of the paper's case."""
    return pack(case, flavour)


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Run an installed command in `tmp_path`: ``command("boreprop", "simulate", …)``."""

    def run(name: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        program = shutil.which(name, path=sysconfig.get_path("scripts"))
        assert program, f"{name} is not installed"
        return run_script([program, *arguments], cwd=tmp_path)

    return run


@pytest.fixture
def command_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Command:
    """The same in this process, where everything is loaded already: for many arguments of one kind."""

    def run(name: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        [entry] = entry_points(group="console_scripts", name=name)
        monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
        monkeypatch.chdir(tmp_path)
        with pytest.raises(SystemExit) as end:
            entry.load()()
        printed = capfd.readouterr()
        return subprocess.CompletedProcess(sys.argv, end.value.code or 0, printed.out, printed.err)  # type: ignore[arg-type]

    return run


def assert_refused(result: subprocess.CompletedProcess[str], *named: str) -> None:
    """Exit status 2, nothing on stdout, one line on stderr that names everything in `named`."""
    assert (result.returncode, result.stdout) == (2, "")
    assert len(result.stderr.splitlines()) == 1, result.stderr
    for name in named:
        assert name in result.stderr
