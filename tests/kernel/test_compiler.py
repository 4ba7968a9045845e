"""The compiler of the kernel and of the FMUs that need no Python: its libraries, its errors, its part in the wheel."""

import ctypes
import os
import re
import shutil
import struct
import subprocess
import sys
import venv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from boreprop.kernel import compiler
from boreprop.kernel.compiler import PLATFORMS, CompilerError, compile_library, host_platform
from places import ROOT

Sources = Callable[[str], Path]  # a name → the path of a C file in a folder of that name

KERNEL = Path("model", "boreprop", "kernel")

EXPORT = """
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
"""
SOURCE = """
#include <math.h>
#include <stdio.h>
#include "export.h"
EXPORT int answer(void) { return ANSWER; }
EXPORT double root(double x) { return cbrt(x); }
EXPORT int say(double x, char text[99]) { return snprintf(text, 99, "%s %s: %g", __FILE__, HEADER, pow(x, 1.5)); }
"""


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """Write a C file, and a header in a folder beside it."""

    def write(name: str) -> Path:
        (tmp_path / name / "include").mkdir(parents=True)
        (tmp_path / name / "include" / "export.h").write_text(EXPORT + "#define HEADER __FILE__\n")
        (tmp_path / name / "toy.c").write_text(SOURCE)
        return tmp_path / name / "toy.c"

    return write


def compiled(source: Path, platform: str | None = None, name: str = "toy.so") -> Path:
    include = [source.parent / "include"]
    return compile_library(source, source.parent / name, include=include, defines={"ANSWER": "42"}, platform=platform)


def test_a_library_for_this_machine_loads(sources: Sources) -> None:
    library = ctypes.CDLL(str(compiled(sources("here"))))
    library.root.restype, library.root.argtypes = ctypes.c_double, [ctypes.c_double]
    assert (library.answer(), library.root(27.0)) == (42, pytest.approx(3.0))


def test_flags_of_the_environment_are_obeyed(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CFLAGS", "-O0 '-DMORE= + 1'")
    source = sources("here")
    source.write_text(SOURCE.replace("ANSWER", "ANSWER MORE"))
    assert ctypes.CDLL(str(compiled(source))).answer() == 43


def test_a_library_that_does_not_compile_leaves_the_old_one(sources: Sources) -> None:
    source = sources("here")
    before = compiled(source).read_bytes()
    source.write_text(SOURCE + "int broken(void) { return nothing; }\n")
    with pytest.raises(CompilerError, match=r"^\S+toy\.c: must compile with \w+, got: .+toy\.c:\d+.+nothing.*$"):
        compiled(source)
    assert {path.name for path in source.parent.iterdir()} == {"include", "toy.c", "toy.so"}
    assert (source.parent / "toy.so").read_bytes() == before


def test_an_unknown_platform_is_named(sources: Sources) -> None:
    with pytest.raises(CompilerError, match=r"^platform: must be one of linux64, .+, got 'win32'$"):
        compiled(sources("here"), "win32")


def test_a_compiler_that_is_not_there_is_named(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "no-such-cc -m64")
    with pytest.raises(CompilerError, match=r"^CC: must be .+, got 'no-such-cc -m64'$"):
        compiled(sources("here"))


COMPILE = """
import sys
from pathlib import Path
from boreprop.kernel.compiler import NoCompilerError, compile_library
try:
    compile_library(Path(sys.argv[1]), Path("toy.so"), platform=sys.argv[2] or None)
except NoCompilerError as error:
    print(error)
"""


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A Python without packages, and so without ziglang."""
    folder: Path = tmp_path_factory.mktemp("bare")
    venv.create(folder)
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


@pytest.mark.parametrize(
    ("platform", "message"),
    [
        ("", r"a C compiler .+ or ziglang must .+ for this machine: pip .+"),
        ("win64", r"ziglang must .+ win64: pip .+"),
    ],
)
def test_without_a_compiler_the_error_says_what_helps(
    sources: Sources, bare: Path, tmp_path: Path, platform: str, message: str
) -> None:
    environment = {
        "PATH": str(tmp_path),
        "PYTHONPATH": str(ROOT / "model"),
        "SYSTEMROOT": os.environ.get("SYSTEMROOT", ""),
    }
    words = [str(bare), "-c", COMPILE, str(sources("here")), platform]
    said = subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout
    assert re.fullmatch(message, said.strip())


def test_the_library_of_this_machines_platform_loads(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> None:
    platform = host_platform()
    if platform is None:
        pytest.skip("no platform of an FMU")
    monkeypatch.setitem(sys.modules, "ziglang", None)  # it cannot be imported, as while pip builds
    assert ctypes.CDLL(str(compiled(sources("here"), platform))).answer() == 42


FAST = ("linux64", "win64")


@pytest.mark.parametrize(
    "platform", [pytest.param(name, marks=() if name in FAST else pytest.mark.slow) for name in PLATFORMS]
)
def test_every_build_for_a_platform_is_the_same(
    sources: Sources, platform: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = f"toy{PLATFORMS[platform].suffix}"
    first = compiled(sources("here"), platform, name).read_bytes()
    monkeypatch.setenv("CFLAGS", "-DANSWER=43")
    monkeypatch.setenv("CPATH", str(ROOT))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1")
    monkeypatch.setenv("TZ", "Asia/Tokyo")
    elsewhere = sources("another_place")
    assert compiled(elsewhere, platform, name).read_bytes() == first
    for folder in (elsewhere.parents[1], Path.home(), Path(sys.prefix)):
        assert str(folder).encode() not in first
    assert architecture(first) == platform
    newest = max(((int(a), int(b)) for a, b in re.findall(rb"GLIBC_(\d+)\.(\d+)", first)), default=(0, 0))
    assert newest <= (2, 17)


def architecture(library: bytes) -> str:
    """The platform that a library's header names, by the formats' own numbers."""
    if library.startswith(b"\x7fELF\x02"):
        return {62: "linux64", 183: "aarch64-linux"}[struct.unpack_from("<H", library, 18)[0]]
    if library.startswith(b"MZ"):
        header = struct.unpack_from("<I", library, 0x3C)[0]
        return {0x8664: "win64"}[struct.unpack_from("<4xH", library, header)[0]]
    magic, processor = struct.unpack_from("<II", library)
    assert magic == 0xFEEDFACF
    return {0x01000007: "darwin64", 0x0100000C: "aarch64-darwin"}[processor]


def test_the_digest_follows_names_and_contents(tmp_path: Path) -> None:
    digests = []
    for name, text in [("a.h", "x"), ("b.c", "y"), ("b.c", "xy"), ("notes.txt", "no source")]:
        (tmp_path / name).write_text(text)
        digests.append(compiler.sources_digest(tmp_path))
    (tmp_path / "b.c").rename(tmp_path / "c.c")
    digests.append(compiler.sources_digest(tmp_path))
    assert digests[2] == digests[3]
    assert len(set(digests)) == 4


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of what the package is built from, without a library; what is compiled in it is not optimized."""
    for name in ("model", "fmu_build", "viz"):
        shutil.copytree(
            ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "binaries", "boreprop_kernel.*")
        )
    for name in (".gitignore", "hatch_build.py", "LICENSE", "pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, tmp_path)
    flags = tmp_path / KERNEL / "compiler.py"
    flags.write_text(flags.read_text(encoding="utf-8").replace('"-O3"', '"-O0"'), encoding="utf-8")
    return tmp_path


def run(tree: Path, *words: str, compiler: str | None = None) -> subprocess.CompletedProcess[str]:
    paths = os.pathsep.join([str(tree / "model"), str(tree / "fmu_build")])
    environment = os.environ | {"PYTHONPATH": paths} | ({"CC": compiler} if compiler else {})
    return subprocess.run(
        [sys.executable, "-m", *words], cwd=tree, env=environment, capture_output=True, text=True, check=False
    )


def build(tree: Path, target: str, compiler: str | None = None) -> tuple[Path, str]:
    """What hatchling builds, and what it says."""
    result = run(tree, "hatchling", "build", "--target", target, "--directory", "dist", compiler=compiler)
    assert result.returncode == 0, result.stderr
    (made,) = (tree / "dist").iterdir()
    return made, result.stdout + result.stderr


def test_a_wheel_has_the_library_and_the_tag_of_its_platform(tree: Path) -> None:
    wheel, said = build(tree, "wheel")
    assert f"Compiled: boreprop/kernel/{compiler.library_path().name}" in said
    assert re.search(r"-py3-none-(?!any)\w+\.whl$", wheel.name)
    names = zipfile.ZipFile(wheel).namelist()
    assert f"boreprop/kernel/{compiler.library_path().name}" in names
    assert not compiler.host_platform() or f"boreprop_fmu/binaries/{compiler.host_platform()}/" in " ".join(names)
    assert {"boreprop/kernel/library.c", "boreprop/kernel/drilling.h"} <= set(names)
    assert not (tree / KERNEL / compiler.library_path().name).exists()


def test_a_wheel_without_a_compiler_is_for_any_platform(tree: Path) -> None:
    shutil.copy(tree / "README.md", tree / KERNEL / compiler.library_path().name)  # an old one is no part of it
    wheel, said = build(tree, "wheel", compiler="no-such-cc")
    assert "The kernel is not compiled, Python does all: CC: must be" in said
    assert wheel.name.endswith("-py3-none-any.whl")
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if "boreprop_kernel" in name]


def test_a_wheel_for_a_platform_is_that_or_none(tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BOREPROP_PLATFORM", "win32")
    result = run(tree, "hatchling", "build", "--target", "wheel", "--directory", "dist")
    assert result.returncode != 0
    assert "platform: must be one of linux64, " in result.stderr
    assert not list(tree.glob("dist/*.whl"))


def test_an_editable_installation_has_the_library_beside_the_sources(tree: Path) -> None:
    run(tree, "hatchling", "build", "--target", "wheel:editable", "--hooks-only").check_returncode()
    assert (tree / KERNEL / compiler.library_path().name).exists()


def test_the_command_prints_what_it_built(tree: Path) -> None:
    result = run(tree, "boreprop.kernel")
    library = Path(result.stdout.strip())
    assert (result.returncode, library) == (0, tree / KERNEL / compiler.library_path().name)
    digest = ctypes.CDLL(str(library)).boreprop_sources_digest
    digest.restype = ctypes.c_char_p
    assert digest().decode() == compiler.sources_digest()


def test_the_command_says_what_is_missing(tree: Path) -> None:
    result = run(tree, "boreprop.kernel", compiler="no-such-cc")
    assert (result.returncode, result.stdout) == (2, "")
    assert re.fullmatch(r"error: CC: must be .+, got 'no-such-cc'\n", result.stderr)
