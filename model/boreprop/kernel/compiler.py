"""Compiles C to shared libraries: for this machine with its own compiler, for any platform of an FMU with ziglang.

What ziglang compiles is the same byte for byte wherever, whenever and by whomever it is compiled.

Needs the standard library only, for the build hook runs it before anything is installed.
"""

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from platform import libc_ver, machine

from ..core.errors import BorepropError
from ..leftovers import temporary_folder

FOLDER = Path(__file__).resolve().parent  # of the kernel's sources

# Results must not depend on the processor: no fused multiply-add, no -march. -O3 vectorizes the loops over the points
# of a step, within the order of operations that C prescribes, and saves a fifth of the time. With -Werror=switch an
# output of the table of quantities that C does not compute is an error.
FLAGS = ("-std=c99", "-O3", "-g0", "-ffp-contract=off", "-fPIC", "-Werror=switch")

# The environment variables that zig gets: where its cache is, and what Windows needs to run anything.
CACHES = {"HOME", "LOCALAPPDATA", "XDG_CACHE_HOME", "ZIG_GLOBAL_CACHE_DIR"}
ENVIRONMENT = CACHES | {"PATH", "SYSTEMROOT", "TEMP", "TMP", "TMPDIR", "USERPROFILE"}


class CompilerError(BorepropError, RuntimeError):
    """Nothing was compiled. The message is one line and says what is missing or wrong, and what helps."""


class NoCompilerError(CompilerError):
    """There is no compiler."""


@dataclass(frozen=True)
class Platform:
    """Where a library is to run.

    Parameters
    ----------
    system, machine
        Operating system and processor, in Python's names.
    target
        The same in zig's names.
    suffix
        How the name of a shared library ends there.
    tag
        The platform of a wheel that holds a library for it: what `target` asks of a machine, in the words of wheels.
    sources
        C files that are part of every library for it.
    links
        Options with which zig links it.
    """

    system: str
    machine: str
    target: str
    suffix: str
    tag: str
    sources: tuple[Path, ...] = ()
    links: tuple[str, ...] = ("-lm",)


# What zig has compiled of glibc, once for all that it links, names the places where it did so.
_LINUX_LINKS = ("-lm", "-Wl,--strip-debug")

PLATFORMS = {  # under the names of FMI 2.0.4
    "linux64": Platform(
        "linux",
        "x86_64",
        "x86_64-linux-gnu.2.17",
        ".so",
        "manylinux_2_17_x86_64.manylinux2014_x86_64",
        links=_LINUX_LINKS,
    ),
    "win64": Platform(
        "win32",
        "x86_64",
        "x86_64-windows-gnu",
        ".dll",
        "win_amd64",
        (FOLDER / "windows.c",),
        ("-nostdlib", "-lucrtbase", "-s"),  # -s leaves out the time of linking; what is exported stays
    ),
    "darwin64": Platform("darwin", "x86_64", "x86_64-macos.11.0", ".dylib", "macosx_11_0_x86_64"),
    "aarch64-linux": Platform(
        "linux",
        "aarch64",
        "aarch64-linux-gnu.2.17",
        ".so",
        "manylinux_2_17_aarch64.manylinux2014_aarch64",
        links=_LINUX_LINKS,
    ),
    "aarch64-darwin": Platform("darwin", "aarch64", "aarch64-macos.11.0", ".dylib", "macosx_11_0_arm64"),
}


def host_platform() -> str | None:
    """The name in `PLATFORMS` of the platform that this Python runs on; None if it is another one."""
    if sys.maxsize < 2**32 or (sys.platform == "linux" and libc_ver()[0] != "glibc"):
        return None
    processor = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine().lower(), machine())
    names = [name for name, made in PLATFORMS.items() if (made.system, made.machine) == (sys.platform, processor)]
    return names[0] if names else None


def compile_library(
    source: Path,
    output: Path,
    *,
    also: Sequence[Path] = (),
    include: Sequence[Path] = (),
    defines: Mapping[str, str] = {},
    platform: str | None = None,
) -> Path:
    """Compile C files and what they include to one shared library.

    Parameters
    ----------
    source
        The C file, or the first of them.
    output
        The library. It appears whole or not at all.
    also
        The other C files.
    include
        Folders with headers; that of `source` is searched in any case.
    defines
        Macros: name → what takes its place.
    platform
        A name of `PLATFORMS`: compile with ziglang, for machines as old as those of glibc 2.17 or macOS 11. The bytes
        then depend on the sources, what they include, `defines`, the name of `output` and the version of ziglang, and
        on nothing else. A library for win64 can call what ucrtbase.dll has, and of printf's family snprintf and
        vsnprintf.
        None: compile for this machine, with $CC and $CFLAGS, else with cc, gcc or clang and $CFLAGS, else with ziglang.

    Returns
    -------
    output

    Raises
    ------
    NoCompilerError
        If there is no compiler.
    CompilerError
        If the source does not compile, or the platform is not known.
    OSError
        If `output` cannot be written.
    """
    folders = [Path(folder).resolve() for folder in (source.parent, *include)]
    compiler = _compiler(platform, folders)
    flags = [*(f"-I{folder}" for folder in folders), *(f"-D{name}={value}" for name, value in defines.items())]
    sources = [*(path.resolve() for path in (source, *also)), *compiler.sources]
    environment = compiler.environment
    output = output.resolve()
    # In a folder of its own, since linkers leave more than the library. They write its name, as it is given, into it.
    with temporary_folder(f".{output.name}.", output.parent) as draft:
        if not CACHES & set(environment):  # zig would not start
            environment["ZIG_GLOBAL_CACHE_DIR"] = str(draft / "cache")
        compiles = [["-c", str(path), "-o", f"{path.stem}.o"] for path in sources]
        link = ["-shared", *(f"{path.stem}.o" for path in sources), "-o", output.name, *compiler.links]
        for tasks in (compiles, [link]):
            _run([[*compiler.command, *flags, *task] for task in tasks], source, draft, environment)
        os.replace(draft / output.name, output)
    return output


def _run(commands: Sequence[Sequence[str]], source: Path, folder: Path, environment: Mapping[str, str]) -> None:
    """Run commands of a compiler side by side in a folder, until all have ended or something ends this."""
    with ExitStack() as stack:
        begun = []
        for command in commands:
            process = subprocess.Popen(
                command,
                cwd=folder,
                env=environment,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                errors="replace",
            )
            begun.append(stack.enter_context(process))
            stack.callback(process.kill)
        for process in begun:
            _, messages = process.communicate()
            if process.returncode:
                raise CompilerError(f"{source}: must compile with {Path(commands[0][0]).name}, got: {_gist(messages)}")


@dataclass(frozen=True)
class _Compiler:
    """What compiles for a platform: a command with flags, its environment, and what else it compiles and links."""

    command: list[str]
    environment: dict[str, str]
    sources: tuple[Path, ...] = ()
    links: tuple[str, ...] = ("-lm",)


def _compiler(platform: str | None, folders: Sequence[Path]) -> _Compiler:
    """The compiler that `compile_library` uses for a platform; with ziglang, C does not see where `folders` are."""
    if platform is not None and platform not in PLATFORMS:
        raise CompilerError(f"platform: must be one of {', '.join(PLATFORMS)}, got {platform!r}")
    if own := [] if platform else _own_compiler():
        return _Compiler([*own, *FLAGS, *_words("CFLAGS")], dict(os.environ))
    if (zig := _zig()) and (made := PLATFORMS.get(platform or host_platform() or "")):
        hidden = [f"-fmacro-prefix-map={folder}{os.sep}=" for folder in folders]
        environment = {name: value for name, value in os.environ.items() if name.upper() in ENVIRONMENT}
        command = [str(zig), "cc", "-target", made.target, *FLAGS, *hidden]
        return _Compiler(command, environment, made.sources, made.links)
    what = "ziglang" if platform else "a C compiler (cc, gcc, clang or $CC) or ziglang"
    target = platform or "this machine"
    raise NoCompilerError(f"{what} must be installed to compile for {target}: pip install ziglang==0.15.2")


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
    """The words of an environment variable; an empty list if it is not set."""
    return shlex.split(os.environ.get(name, ""), posix=os.name == "posix")


def _zig() -> Path | None:
    """The program zig of the package ziglang, if that is installed."""
    # While pip builds, the packages of the environment cannot be imported, but their folders are known.
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


def library_path(platform: str | None = None) -> Path:
    """Where the kernel's library for a platform, or else for this machine, is or would be."""
    own = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
    return FOLDER / f"boreprop_kernel{PLATFORMS[platform].suffix if platform else own}"


def sources_digest(*folders: Path) -> str:
    """A digest of the C in these folders, else of the kernel; a library says which sources it was made from."""
    digest = sha256()
    for path in [path for folder in folders or (FOLDER,) for path in sorted(folder.glob("*.[ch]"))]:
        text = path.read_bytes()
        digest.update(f"{path.name} {len(text)}\n".encode() + text)
    return digest.hexdigest()[:16]


def build_library(output: Path | None = None, platform: str | None = None) -> Path:
    """Compile the kernel, to `output` or `library_path`; the rest is as in `compile_library`."""
    defines = {"BOREPROP_SOURCES_DIGEST": f'"{sources_digest()}"'}
    output = output or library_path(platform)
    return compile_library(FOLDER / "library.c", output, also=[FOLDER / "space.c"], defines=defines, platform=platform)
