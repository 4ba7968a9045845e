"""FMUs that are meant to do harm: they are refused before anything of them is unpacked or parsed."""

import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from stat import S_IFIFO, S_IFLNK

import fmpy
import pytest

from boreprop.case.archive import open_archive
from boreprop.case.case import Case
from boreprop.case.packed import CASE_FILE, read_packed_case
from boreprop.errors import InputError
from boreprop_fmu.host.drive import FmuRun
from boreprop_fmu.pack.build import build_fmu
from conftest import Command, assert_refused
from flavours import Flavour, both_flavours, build_to_read

Files = dict[str, bytes]
DESCRIPTION = "modelDescription.xml"
DOCUMENT_TYPE = "<!DOCTYPE x [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;'>]>"


def files_of(fmu: Path) -> Files:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def pack(files: Files, path: Path, *, extra: tuple[zipfile.ZipInfo, bytes] | None = None) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
        if extra:
            archive.writestr(*extra)
    return path


def entry(name: str, mode: int = 0) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo("x")
    info.filename = info.orig_filename = name
    info.external_attr = mode << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    return info


EXTRA = {
    "absolute": (entry("/tmp/boreprop-evil"), b"evil"),
    "absolute on Windows": (entry("C:/evil"), b"evil"),
    "share of Windows": (entry(r"\\host\evil"), b"evil"),
    "parent": (entry("../evil"), b"evil"),
    "parent in the middle": (entry("resources/../../evil"), b"evil"),
    "parent at the end": (entry("resources/.."), b"evil"),
    "parent on Windows": (entry(r"resources\..\..\evil"), b"evil"),
    "parent with a blank": (entry(".. /evil"), b"evil"),
    "here": (entry("."), b"evil"),
    "no name": (entry(""), b"evil"),
    "double slash": (entry("resources//evil"), b"evil"),
    "link": (entry("resources/link", S_IFLNK | 0o777), b"/etc/passwd"),
    "pipe": (entry("resources/pipe", S_IFIFO | 0o644), b""),
    "bomb": (entry("resources/zeros"), bytes(20 << 20)),
    "twice": (entry(DESCRIPTION), b"<x/>"),
}


@both_flavours
@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("extra", EXTRA.values(), ids=EXTRA)
def test_a_hostile_file_in_an_fmu(
    command_here: Command,
    case: Case,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    flavour: Flavour,
    extra: tuple[zipfile.ZipInfo, bytes],
) -> None:
    fmu = pack(files_of(build_to_read(case, tmp_path / "sound.fmu", flavour)), tmp_path / "evil.fmu", extra=extra)
    monkeypatch.setattr(fmpy, "read_model_description", None)  # would fail otherwise
    before = set(tmp_path.rglob("*"))
    for read in (read_packed_case, FmuRun):
        with pytest.raises(InputError, match=r"evil\.fmu: must "):
            read(fmu)
    assert_refused(command_here("boreprop-fmu", "run", "evil.fmu", "--output", "run.csv"), "evil.fmu: must ")
    assert_refused(command_here("boreprop-view", "evil.fmu", "--save", "run.rrd"), "evil.fmu: must ")
    assert set(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_description_with_entities(case: Case, tmp_path: Path, encoding: str) -> None:
    files = files_of(build_fmu(case, tmp_path / "sound.fmu", runtime="python"))
    body = files[DESCRIPTION].decode().partition("?>")[2]
    files[DESCRIPTION] = f"<?xml version='1.0' encoding='{encoding}'?>{DOCUMENT_TYPE}{body}".encode(encoding)
    with pytest.raises(InputError, match=r"must be XML without a document type and its entities"):
        FmuRun(pack(files, tmp_path / "evil.fmu"))


def lie(data: bytearray, name: bytes, size: int | None = None, packed: int | None = None) -> bytearray:
    """Say in both of a ZIP archive's records of a file that it has another size, unpacked or packed."""
    for signature, offset, length in ((b"PK\3\4", 18, 30), (b"PK\1\2", 20, 46)):
        at = next(i for i in range(len(data)) if data[i : i + 4] == signature and data[i + length :].startswith(name))
        old = struct.unpack_from("<II", data, at + offset)
        struct.pack_into("<II", data, at + offset, packed or old[0], size or old[1])
    return data


@pytest.mark.parametrize(
    "sizes", [{"size": 0xFFFFFFF0}, {"packed": 0xFFFFFFF0}, {"size": 0xFFFFFFF0, "packed": 0xFFFFFFF0}]
)
def test_an_archive_that_lies_about_a_size(case: Case, tmp_path: Path, sizes: dict[str, int]) -> None:
    fmu = build_fmu(case, tmp_path / "Borehole.fmu", runtime="python")
    fmu.write_bytes(lie(bytearray(fmu.read_bytes()), CASE_FILE.encode(), **sizes))
    with pytest.raises(InputError, match=r"Borehole\.fmu: must "):
        read_packed_case(fmu)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda data: b"",
        lambda data: data[: len(data) // 2],
        lambda data: data[:2000] + bytes(100) + data[2100:],
        lambda data: data.replace(b"PK\3\4", b"PK\3\5"),
    ],
)
def test_a_damaged_archive(case: Case, tmp_path: Path, spoil: Callable[[bytes], bytes]) -> None:
    fmu = build_fmu(case, tmp_path / "Borehole.fmu", runtime="python")
    fmu.write_bytes(spoil(fmu.read_bytes()))
    with pytest.raises(InputError, match=r"Borehole\.fmu"):
        FmuRun(fmu)


@both_flavours
def test_our_own_fmus_are_far_from_the_bounds(case: Case, tmp_path: Path, flavour: Flavour) -> None:
    fmu = build_fmu(case, tmp_path / "Borehole.fmu", runtime=flavour.runtime)
    with open_archive(fmu) as archive:
        growth = [file.file_size / file.compress_size for file in archive.infolist()]
    assert max(growth) < 30.0
