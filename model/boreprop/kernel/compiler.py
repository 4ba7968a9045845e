"""Compiles C to shared libraries: for this machine with its own compiler, for any platform of an FMU with ziglang.

What ziglang compiles is the same byte for byte wherever, whenever and by whomever it is compiled.

Needs the standard library only and imports nothing of the package: the build hook loads this file by its path.
"""

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from platform import libc_ver, machine
from tempfile import TemporaryDirectory

FOLDER = Path(__file__).resolve().parent  # of the kernel's sources

# results must not depend on the processor: no fused multiply-add, no -march. -O3 vectorizes the loops over the points
# of a step, within the order of operations that C prescribes, and saves a fifth of the time. No output of the table of
# quantities may be left out where they are computed.
FLAGS = ("-std=c99", "-O3", "-g0", "-ffp-contract=off", "-fPIC", "-Werror=switch")

# what zig may know of its surroundings: where its cache is, and what Windows needs to run anything
CACHES = {"HOME", "LOCALAPPDATA", "XDG_CACHE_HOME", "ZIG_GLOBAL_CACHE_DIR"}
ENVIRONMENT = CACHES | {"PATH", "SYSTEMROOT", "TEMP", "TMP", "TMPDIR", "USERPROFILE"}


class CompilerError(RuntimeError):
    """Nothing was compiled. The message says on one line what is missing or wrong and what helps."""


class NoCompilerError(CompilerError):
    """There is nothing to compile with."""


@dataclass(frozen=True)
class Platform:
    """Where a library is to run.

    Parameters
    ----------
    system, machine
        Its operating system and processor, as Python calls them.
    target
        The same, as zig calls them.
    suffix
        Of its shared libraries.
    sources
        C files that are part of every library for it.
    links
        What zig is told to link it with.
    """

    system: str
    machine: str
    target: str
    suffix: str
    sources: tuple[Path, ...] = ()
    links: tuple[str, ...] = ("-lm",)


PLATFORMS = {  # under the names of FMI 2.0.4
    "linux64": Platform("linux", "x86_64", "x86_64-linux-gnu.2.17", ".so"),
    "win64": Platform(
        "win32",
        "x86_64",
        "x86_64-windows-gnu",
        ".dll",
        (FOLDER / "windows.c",),
        ("-nostdlib", "-lucrtbase", "-s"),  # not stripped it would hold when it was linked; what it exports stays
    ),
    "darwin64": Platform("darwin", "x86_64", "x86_64-macos.11.0", ".dylib"),
    "aarch64-linux": Platform("linux", "aarch64", "aarch64-linux-gnu.2.17", ".so"),
    "aarch64-darwin": Platform("darwin", "aarch64", "aarch64-macos.11.0", ".dylib"),
}


def host_platform() -> str | None:
    """The name in `PLATFORMS` of what this Python runs on; None if it is none of them."""
    if sys.maxsize < 2**32 or (sys.platform == "linux" and libc_ver()[0] != "glibc"):
        return None
    processor = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine().lower(), machine())
    names = [name for name, made in PLATFORMS.items() if (made.system, made.machine) == (sys.platform, processor)]
    return names[0] if names else None


def compile_library(
    source: Path,
    output: Path,
    *,
    include: Sequence[Path] = (),
    defines: Mapping[str, str] = {},
    platform: str | None = None,
) -> Path:
    """Compile one C file and what it includes to one shared library.

    Parameters
    ----------
    source
        The C file.
    output
        The library. It appears whole or not at all.
    include
        Folders with headers; that of `source` is searched in any case.
    defines
        Macros: name → what takes its place.
    platform
        A name of `PLATFORMS`: with ziglang, for machines as old as with glibc 2.17 or macOS 11. The bytes depend on
        `source`, what it includes, `defines`, the name of `output` and the version of ziglang, on nothing else.
        For win64 there is of the C library what ucrtbase.dll has, and of printf's family snprintf and vsnprintf.
        None: for this machine, with $CC, else cc, gcc or clang, else ziglang; $CFLAGS are for the former.

    Returns
    -------
    output

    Raises
    ------
    NoCompilerError
        If there is no compiler.
    CompilerError
        If it finds a mistake, or the platform is not known.
    OSError
        If `output` cannot be written.
    """
    if platform is not None and platform not in PLATFORMS:
        raise CompilerError(f"platform: must be one of {', '.join(PLATFORMS)}, got {platform!r}")
    folders = [Path(folder).resolve() for folder in (source.parent, *include)]
    sources = [source.resolve()]
    links: tuple[str, ...] = ("-lm",)
    if compiler := [] if platform else _own_compiler():
        flags = _words("CFLAGS")
        environment = dict(os.environ)
    elif (zig := _zig()) and (made := PLATFORMS.get(platform or host_platform() or "")):
        compiler = [str(zig), "cc", "-target", made.target]
        flags = [f"-fmacro-prefix-map={folder}{os.sep}=" for folder in folders]
        sources, links = [*sources, *made.sources], made.links
        environment = {name: value for name, value in os.environ.items() if name.upper() in ENVIRONMENT}
    else:
        what = "ziglang" if platform else "a C compiler (cc, gcc, clang or $CC) or ziglang"
        target = platform or "this machine"
        raise NoCompilerError(f"{what} must be installed to compile for {target}: pip install ziglang==0.15.2")

    flags += [f"-I{folder}" for folder in folders]
    flags += [f"-D{name}={value}" for name, value in defines.items()]
    output = output.resolve()
    # linkers leave more than the library, and write its name, as it is given, into it
    with TemporaryDirectory(dir=output.parent, prefix=f".{output.name}.") as draft:
        if not CACHES & set(environment):  # zig would not start
            environment["ZIG_GLOBAL_CACHE_DIR"] = str(Path(draft, "cache"))
        compiles = [["-c", str(path), "-o", f"{path.stem}.o"] for path in sources]
        link = ["-shared", *(f"{path.stem}.o" for path in sources), "-o", output.name, *links]
        for task in (*compiles, link):
            command = [*compiler, *FLAGS, *flags, *task]
            run = subprocess.run(command, cwd=draft, env=environment, capture_output=True, text=True, errors="replace")
            if run.returncode:
                raise CompilerError(f"{source}: must compile with {Path(compiler[0]).name}, got: {_gist(run.stderr)}")
        os.replace(Path(draft) / output.name, output)
    return output


def _own_compiler() -> list[str]:
    """The command of a compiler for this machine; empty if there is none."""
    named = _words("CC")
    for words in [named] if named else [["cc"], ["gcc"], ["clang"]]:
        program = shutil.which(words[0])
        if program:
            return [os.path.abspath(program), *words[1:]]
    if named:
        raise CompilerError(f"CC: must be the command of a C compiler, got {' '.join(named)!r}")
    return []


def _words(name: str) -> list[str]:
    """The words of an environment variable; none if it is not set."""
    return shlex.split(os.environ.get(name, ""), posix=os.name == "posix")


def _zig() -> Path | None:
    """The program zig of the package ziglang, if that is installed."""
    # pip hides the packages of an environment from what it builds there, but not where they are
    folders = [sysconfig.get_path("purelib"), sysconfig.get_path("platlib")]
    spec = find_spec("ziglang")
    if spec and spec.origin:
        folders.insert(0, str(Path(spec.origin).parents[1]))
    programs = [Path(folder, "ziglang", "zig.exe" if os.name == "nt" else "zig") for folder in folders]
    return next(filter(Path.exists, programs), None)


def _gist(messages: str) -> str:
    """The first error among a compiler's messages, or their last line."""
    lines = [line.strip() for line in messages.splitlines() if line.strip()] or ["no message"]
    return next((line for line in lines if "error" in line), lines[-1])


def library_path() -> Path:
    """Where the kernel's library for this machine is, or would be."""
    suffix = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
    return FOLDER / f"boreprop_kernel{suffix}"


def sources_digest(*folders: Path) -> str:
    """A digest of the C in these folders, else of the kernel; a library says which sources it was made from."""
    digest = sha256()
    for path in [path for folder in folders or (FOLDER,) for path in sorted(folder.glob("*.[ch]"))]:
        text = path.read_bytes()
        digest.update(f"{path.name} {len(text)}\n".encode() + text)
    return digest.hexdigest()[:16]


def build_library(output: Path | None = None) -> Path:
    """Compile the kernel for this machine, to `library_path` if not told otherwise; errors as in `compile_library`."""
    defines = {"BOREPROP_SOURCES_DIGEST": f'"{sources_digest()}"'}
    return compile_library(FOLDER / "library.c", output or library_path(), defines=defines)
