"""The archives together: which there are, that they are the same wherever they are built, what other tools say."""

import os
import shutil
import subprocess
import sys
import tarfile
from hashlib import sha256
from pathlib import Path

import pytest

from boreprop.kernel.compiler import PLATFORMS
from places import ROOT

LINUX = [name for name, made in PLATFORMS.items() if made.system == "linux"]
NOT_PACKED = (".ci/", "out/")  # what is committed, and no part of the source distribution


def module(*words: str | Path, cwd: Path = ROOT, **settings: str) -> str:
    """What a module of this Python prints."""
    command = [sys.executable, "-m", *map(str, words)]
    environment = {**os.environ, "NO_COLOR": "1", "COLUMNS": "200", **settings}
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def sdist(archives: Path) -> Path:
    (found,) = archives.glob("*.tar.gz")
    return found


def test_there_is_a_wheel_for_each_platform_and_a_source_distribution(archives: Path) -> None:
    base = sdist(archives).name.removesuffix(".tar.gz")
    wheels = {f"{base}-py3-none-{made.tag}.whl" for made in PLATFORMS.values()}
    assert {path.name for path in archives.iterdir()} == {f"{base}.tar.gz"} | wheels


def test_built_from_the_source_distribution_in_another_folder_they_are_the_same(archives: Path, tmp_path: Path) -> None:
    with tarfile.open(sdist(archives)) as archive:
        archive.extraction_filter = getattr(tarfile, "data_filter", None)  # which Python 3.11.3 has not
        archive.extractall(tmp_path)
        date = str(int(archive.getmembers()[0].mtime))
    (tree,) = tmp_path.iterdir()
    # and nothing is left of what zig has compiled before, here or in another place
    settings = {"SOURCE_DATE_EPOCH": date, "ZIG_GLOBAL_CACHE_DIR": str(tmp_path / "cache")}
    command = [sys.executable, "build_wheels.py", str(tmp_path / "dist")]
    subprocess.run(command, cwd=tree, env=os.environ | settings, check=True, capture_output=True)
    first, again = (
        {path.name: sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
        for folder in (archives, tmp_path / "dist")
    )
    assert again == first


def test_the_source_distribution_holds_what_is_committed(archives: Path) -> None:
    if not (ROOT / ".git").exists() or not shutil.which("git"):
        pytest.skip("not a git checkout")
    listing = ["git", "-c", f"safe.directory={ROOT}", "ls-files", "-z"]
    committed = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")[:-1]
    with tarfile.open(sdist(archives)) as archive:
        names = [name.partition("/")[2] for name in archive.getnames()]
    assert sorted(names) == sorted(["PKG-INFO", *(name for name in committed if not name.startswith(NOT_PACKED))])


def test_twine_finds_nothing_to_say(archives: Path) -> None:
    assert "PASSED" in module("twine", "check", "--strict", *sorted(archives.iterdir()))


@pytest.mark.skipif(sys.platform != "linux", reason="auditwheel is for Linux")
@pytest.mark.parametrize("name", LINUX)
def test_auditwheel_agrees_with_the_tag(archives: Path, name: str) -> None:
    (wheel,) = archives.glob(f"*-{PLATFORMS[name].tag}.whl")
    said = module("auditwheel", "show", wheel)
    assert f'platform tag:\n"{PLATFORMS[name].tag.partition(".")[0]}"' in said
