"""What a shared library says of itself, in the format of any system."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import macholib.mach_o
import pefile
from elftools.elf.elffile import ELFFile
from macholib.MachO import MachO
from macholib.SymbolTable import SymbolTable

N_TYPE, N_SECT, N_EXT, N_STAB = 0x0E, 0x0E, 0x01, 0xE0  # bits of a symbol in a library of macOS
LINKERS = {"__dso_handle", "_mh_dylib_header", "dyld_private"}  # symbols that a linker makes


@dataclass(frozen=True)
class Library:
    """A library for one processor.

    Parameters
    ----------
    system, processor
        What it is for, in Python's names.
    needs
        Names of the libraries that it is loaded with.
    exports
        Names of the functions that it has for others.
    oldest
        The version of the system from which on it loads: of glibc or macOS; (0,) where it does not say.
    inside
        On Linux the source files, on macOS the functions that it was linked from, unless it is stripped.
    signed
        Whether it holds a signature, without which Apple's processors run nothing.
    """

    system: str
    processor: str
    needs: frozenset[str]
    exports: frozenset[str]
    oldest: tuple[int, ...] = (0,)
    inside: frozenset[str] = field(default=frozenset())
    signed: bool = False


def libraries_in(content: bytes) -> list[Library]:
    """The library in a file, or those for each processor."""
    if content.startswith(b"\x7fELF"):
        return [elf(content)]
    if content.startswith(b"MZ"):
        return [portable_executable(content)]
    return list(mach(content))


def elf(content: bytes) -> Library:
    file: Any = ELFFile(BytesIO(content))
    versions = [
        version.name
        for _, required in file.get_section_by_name(".gnu.version_r").iter_versions()
        for version in required
    ]
    dynamic, symbols = (file.get_section_by_name(name) for name in (".dynsym", ".symtab"))
    return Library(
        "linux",
        {"EM_X86_64": "x86_64", "EM_AARCH64": "aarch64"}[file["e_machine"]],
        frozenset(tag.needed for tag in file.get_section_by_name(".dynamic").iter_tags("DT_NEEDED")),
        frozenset(
            symbol.name
            for symbol in dynamic.iter_symbols()
            if symbol["st_info"]["bind"] == "STB_GLOBAL" and symbol["st_shndx"] != "SHN_UNDEF"
        ),
        max(tuple(map(int, name.removeprefix("GLIBC_").split("."))) for name in versions),
        frozenset(
            symbol.name
            for symbol in (symbols.iter_symbols() if symbols else ())
            if symbol["st_info"]["type"] == "STT_FILE"
        ),
    )


def portable_executable(content: bytes) -> Library:
    file = pefile.PE(data=content)
    return Library(
        "win32",
        {0x8664: "x86_64"}[file.FILE_HEADER.Machine],
        frozenset(entry.dll.decode() for entry in file.DIRECTORY_ENTRY_IMPORT),
        frozenset(symbol.name.decode() for symbol in file.DIRECTORY_ENTRY_EXPORT.symbols),
    )


def mach(content: bytes) -> Iterator[Library]:
    with TemporaryDirectory() as place:
        path = Path(place, "library")
        path.write_bytes(content)  # macholib reads files only
        file = MachO(str(path))
        for part in file.headers:
            commands = {load.cmd: command for load, command, _ in part.commands}
            minimum = commands[macholib.mach_o.LC_BUILD_VERSION].minos
            defined = {
                name.decode(): symbol
                for symbol, name in SymbolTable(file, part).nlists
                if not symbol.n_type & N_STAB and symbol.n_type & N_TYPE == N_SECT
            }
            yield Library(
                "darwin",
                {0x01000007: "x86_64", 0x0100000C: "aarch64"}[part.header.cputype],
                frozenset(name for _, _, name in part.walkRelocatables()),
                frozenset(name.removeprefix("_") for name, symbol in defined.items() if symbol.n_type & N_EXT)
                - LINKERS,
                (minimum >> 16, minimum >> 8 & 255),
                frozenset(name.removeprefix("_") for name in defined) - LINKERS,
                macholib.mach_o.LC_CODE_SIGNATURE in commands,
            )
