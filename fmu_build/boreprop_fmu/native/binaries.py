"""Compiles the native FMU, two binaries a platform, in the plane and in space, and finds what is compiled.

A binary says which sources it was made from. Needs the standard library only: the build hook imports it.
"""

import re
import struct
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from boreprop.errors import InputError
from boreprop.kernel import compiler
from boreprop.kernel.compiler import CompilerError, NoCompilerError, compile_library, host_platform, sources_digest
from boreprop.leftovers import temporary_folder
from boreprop.replacing import replacing

NATIVE = Path(__file__).resolve().parent
BINARIES = NATIVE.parent / "binaries"
SOURCE = NATIVE / "fmi2.c"
INCLUDE = (compiler.FOLDER, NATIVE / "importer")  # where headers are: the kernel's, and those of FMI
PLATFORMS = tuple(compiler.PLATFORMS)
SPACE = "SPACE"  # is defined for what drills in space, see kernel/dimensions.h
LAWS = (False, True)  # whether a binary is for space
UNIVERSAL = {"darwin64": ("darwin64", "aarch64-darwin")}  # hosts on either processor look into darwin64

MARK = re.compile(rb"boreprop-fmu-sources-(\w+)")  # in a binary, see packed_case.h
FAT_MAGIC, FAT_ALIGNMENT = 0xCAFEBABE, 14  # of a universal file; slices begin at multiples of 2^14, the largest page
MACH_MAGIC = 0xFEEDFACF


def digest() -> str:
    """A digest of the sources of the FMU, as a binary that is made from them has it."""
    return sources_digest(NATIVE, *INCLUDE)


def check_platform(platform: str) -> None:
    """Raise `InputError` if there is no such platform."""
    if platform not in PLATFORMS:
        raise InputError(f"platform: must be one of {', '.join(PLATFORMS)}, got {platform!r}")


def binary_path(platform: str, folder: Path = BINARIES, in_space: bool = False) -> Path:
    """Where the binary for a platform, in the plane or in space, is, or would be."""
    name = "BoreholeInSpace" if in_space else "Borehole"
    return folder / platform / f"{name}{compiler.PLATFORMS[platform].suffix}"


def build_binaries(platforms: Iterable[str] = (), folder: Path = BINARIES) -> Iterator[Path]:
    """Compile binaries, one after the other, and take away those of other sources.

    Parameters
    ----------
    platforms
        Names of `PLATFORMS`, to be compiled with ziglang. Without any: this machine, with its own compiler where there
        is no ziglang.
    folder
        Where they go, each into the folder of its platform.

    Yields
    ------
    Each as soon as it is there.

    Raises
    ------
    CompilerError
        If there is no compiler, or it fails.
    InputError
        If there is no such platform.
    OSError
        If a file cannot be written.
    """
    names = list(platforms)
    for platform in PLATFORMS:
        for in_space in LAWS:
            if not is_compiled(platform, folder, in_space):
                binary_path(platform, folder, in_space).unlink(missing_ok=True)
    if names:
        for platform in names:
            for in_space in LAWS:
                yield build_binary(platform, folder, in_space)
        return
    host = host_platform()
    if host is None:
        raise CompilerError(f"platform: must be one of {', '.join(PLATFORMS)}, got this machine, which is none")
    for in_space in LAWS:
        try:
            yield build_binary(host, folder, in_space)
        except NoCompilerError:
            yield compile_binary(binary_path(host, folder, in_space), None, in_space)


def build_binary(platform: str, folder: Path = BINARIES, in_space: bool = False) -> Path:
    """Compile a binary for a platform with ziglang; errors as in `build_binaries`."""
    check_platform(platform)
    output = binary_path(platform, folder, in_space)
    if platform not in UNIVERSAL:
        return compile_binary(output, platform, in_space)
    with temporary_folder("boreprop-fmu-") as drafts:
        paths = [(name, binary_path(name, drafts, in_space)) for name in UNIVERSAL[platform]]
        slices = [compile_binary(path, name, in_space).read_bytes() for name, path in paths]
    output.parent.mkdir(parents=True, exist_ok=True)
    with replacing(output) as draft:
        draft.write_bytes(join(slices))
    return output


def compile_binary(output: Path, platform: str | None, in_space: bool = False) -> Path:
    """Compile for one processor: with ziglang for a platform, or for this machine with its own compiler."""
    output.parent.mkdir(parents=True, exist_ok=True)
    defines = {"BOREPROP_SOURCES_DIGEST": f'"{digest()}"'} | ({SPACE: "1"} if in_space else {})
    return compile_library(SOURCE, output, include=INCLUDE, defines=defines, platform=platform)


def is_current(binary: bytes) -> bool:
    """Whether a binary is made from the sources as they are, all its parts."""
    return set(MARK.findall(binary)) == {digest().encode()}


def is_compiled(platform: str, folder: Path = BINARIES, in_space: bool = False) -> bool:
    """Whether there is a binary for a platform, of the sources as they are."""
    path = binary_path(platform, folder, in_space)
    return path.exists() and is_current(path.read_bytes())


def join(libraries: Sequence[bytes]) -> bytes:
    """One universal library of macOS, made of one for each processor."""
    step = 1 << FAT_ALIGNMENT
    header = struct.pack(">2I", FAT_MAGIC, len(libraries))
    body = b""
    for library in libraries:
        magic, processor, model = struct.unpack_from("<3I", library)
        if magic != MACH_MAGIC:
            raise ValueError(f"library: must be a 64-bit library of macOS, got one that begins with {magic:#010x}")
        body += bytes(-len(body) % step)
        header += struct.pack(">5I", processor, model, step + len(body), len(library), FAT_ALIGNMENT)
        body += library
    return header.ljust(step, b"\0") + body
