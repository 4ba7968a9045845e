"""What is in a wheel, what its libraries ask of a machine, and what of other people's is in them."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from email import message_from_bytes
from pathlib import Path

import pytest

from boreprop.kernel.compiler import FOLDER, PLATFORMS, build_library, library_path
from boreprop_fmu.native.binaries import INCLUDE, LAWS, NATIVE, UNIVERSAL, binary_path, compile_binary, is_current
from libraries import Library, elf, libraries_in
from places import ROOT

PACKAGES = {"boreprop": "model", "boreprop_fmu": "fmu_build", "boreprop_viz": "viz"}
THIRD_PARTY = FOLDER / "THIRD_PARTY.txt"

# what every machine of a system has, and the oldest system that wheels and FMUs promise to run on
SYSTEM = {
    "linux": ({"libc.so.6", "libm.so.6", "libpthread.so.0"}, (2, 17)),
    "win32": ({"ucrtbase.dll"}, (0,)),
    "darwin": ({"/usr/lib/libSystem.B.dylib"}, (11, 0)),
}


def metadata(contents: Mapping[str, bytes], name: str) -> bytes:
    """A file of the folder .dist-info."""
    (found,) = [content for path, content in contents.items() if path.endswith(f".dist-info/{name}")]
    return found


def kernel(platform: str) -> str:
    return f"boreprop/kernel/{library_path(platform).name}"


def fmu(platform: str, in_space: bool) -> str:
    return f"boreprop_fmu/binaries/{platform}/{binary_path(platform, in_space=in_space).name}"


def libraries(contents: Mapping[str, bytes], platform: str) -> Iterator[tuple[str, Library]]:
    """Each library in a wheel for a platform, and its C file."""
    for path, source in [
        (kernel(platform), "library.c"),
        *((fmu(name, law), "fmi2.c") for name in PLATFORMS for law in LAWS),
    ]:
        for library in libraries_in(contents[path]):
            yield source, library


def test_its_name_and_its_tags_say_for_which_machines_it_is(
    wheel: Path, contents: dict[str, bytes], target: str
) -> None:
    tag = PLATFORMS[target].tag
    about = message_from_bytes(metadata(contents, "WHEEL"))
    assert wheel.name.endswith(f"-py3-none-{tag}.whl")
    assert about.get_all("Tag") == [f"py3-none-{part}" for part in sorted(tag.split("."))]
    assert about["Root-Is-Purelib"] == "false"


def test_its_description_is_the_readme_without_what_leads_to_other_files(contents: dict[str, bytes]) -> None:
    head, _, text = metadata(contents, "METADATA").decode().partition("\n\n")
    assert "\nDescription-Content-Type: text/markdown" in head
    assert not re.findall(r"\]\((?!https?://)|docs/", text)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert [line for line in text.splitlines() if line not in readme.splitlines()] == [
        line.replace("[Install](docs/install.md)", "Install") for line in readme.splitlines() if "[Install]" in line
    ]
    assert readme[readme.index("From Python:") : readme.index("## Documentation")] in text
    assert [line for line in text.splitlines() if line.startswith("    ")] == [
        line for line in readme.splitlines() if line.startswith("    ")
    ]
    assert text.rstrip().splitlines()[-1] == readme.rstrip().splitlines()[-1]


def test_it_holds_the_packages_and_the_libraries_and_nothing_else(contents: dict[str, bytes], target: str) -> None:
    sources = {
        f"{name}/{path.relative_to(ROOT / root / name).as_posix()}": path
        for name, root in PACKAGES.items()
        for path in (ROOT / root / name).rglob("*")
        if path.is_file() and not {"__pycache__", "binaries"} & set(path.parts) and path.stem != library_path().stem
    }
    packed = {path for path in contents if ".dist-info/" not in path}
    assert packed == set(sources) | {kernel(target)} | {fmu(name, law) for name in PLATFORMS for law in LAWS}
    assert [name for name, path in sources.items() if contents[name] != path.read_bytes()] == []


def test_its_libraries_are_for_the_processors_that_they_should_be_for(contents: dict[str, bytes], target: str) -> None:
    for path, names in [(kernel(target), (target,))] + [
        (fmu(p, law), UNIVERSAL.get(p, (p,))) for p in PLATFORMS for law in LAWS
    ]:
        wanted = [(PLATFORMS[name].system, PLATFORMS[name].machine) for name in names]
        assert [(library.system, library.processor) for library in libraries_in(contents[path])] == wanted, path


def test_its_binaries_of_the_fmu_are_of_these_sources(contents: dict[str, bytes]) -> None:
    assert [fmu(name, law) for name in PLATFORMS for law in LAWS if not is_current(contents[fmu(name, law)])] == []


def test_no_library_needs_more_than_its_platform_promises(contents: dict[str, bytes], target: str) -> None:
    for source, library in libraries(contents, target):
        there, oldest = SYSTEM[library.system]
        assert library.needs <= there, source
        assert library.oldest <= oldest, source
        assert library.signed or (library.system, library.processor) != ("darwin", "aarch64"), source


def test_libraries_export_their_interface_only(contents: dict[str, bytes], target: str) -> None:
    for source, library in libraries(contents, target):
        begin = "boreprop_" if source == "library.c" else "fmi2"
        assert len(library.exports) > 10
        assert [name for name in library.exports if not name.startswith(begin)] == []


def test_nothing_of_others_is_linked_into_those_for_a_mac(contents: dict[str, bytes], target: str) -> None:
    folders = (NATIVE, *INCLUDE)
    own = {
        word for folder in folders for path in folder.glob("*.[ch]") for word in re.findall(r"\w+", path.read_text())
    }
    for _, library in libraries(contents, target):
        if library.system == "darwin":
            assert len(library.inside) > 20
            parts = [name for name in library.inside if not name.endswith("__thunk")]
            assert {name.partition(".")[0] for name in parts} - own == set()


@pytest.mark.parametrize("name", [name for name, platform in PLATFORMS.items() if platform.system == "linux"])
def test_what_of_others_is_linked_into_those_for_linux_is_named(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("ziglang")
    stripped = elf(compile_binary(tmp_path / "stripped.so", name).read_bytes())
    monkeypatch.setitem(PLATFORMS, name, replace(PLATFORMS[name], links=("-lm",)))
    binary, kernel = (
        elf(path.read_bytes())
        for path in (compile_binary(tmp_path / "a.so", name), build_library(tmp_path / "b.so", name))
    )
    assert binary.needs == stripped.needs
    assert binary.exports == stripped.exports
    assert binary.inside == {"fmi2.c", "stat-2.32.c"}
    assert kernel.inside == {"library.c", "space.c"}
    assert "io/stat-2.32.c" in THIRD_PARTY.read_text(encoding="utf-8")


def test_it_has_the_licenses_of_all_that_is_in_it(contents: dict[str, bytes]) -> None:
    about = message_from_bytes(metadata(contents, "METADATA"))
    files = {"LICENSE": ROOT / "LICENSE", THIRD_PARTY.relative_to(ROOT).as_posix(): THIRD_PARTY}
    assert about.get_all("License-File") == list(files)
    assert about["License-Expression"] == "MIT"
    for name, path in files.items():
        assert metadata(contents, f"licenses/{name}") == path.read_bytes()


def test_it_names_no_place_of_the_machine_that_built_it(contents: dict[str, bytes]) -> None:
    paths = re.compile(rb"(?<![\w/:.])/(?:[\w.+-]+/)+[\w.+-]+")
    for name, content in contents.items():
        if name.endswith((".so", ".dll", ".dylib")):
            assert set(paths.findall(content)) <= {b"/usr/lib/dyld", b"/usr/lib/libSystem.B.dylib"}, name
        assert bytes(ROOT / "_")[:-1] not in content, name
