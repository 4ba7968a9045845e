"""Builds the source distribution and, from it, a wheel for each platform: ``python build_wheels.py [FOLDER]``.

It needs hatchling and ziglang, on any machine. The same commit gives the same bytes, wherever and whenever it is
built with the same versions of the two: the date of every file is that of the commit, or `SOURCE_DATE_EPOCH`.
"""

import os
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "model"))

from boreprop.kernel.compiler import PLATFORMS  # noqa: E402


def build_all(output: Path) -> Iterator[Path]:
    """Build into a folder, and yield each archive as soon as it is there."""
    output.mkdir(parents=True, exist_ok=True)
    dated = {"SOURCE_DATE_EPOCH": date} if (date := commit_date()) else {}
    with TemporaryDirectory() as place:
        sources = build("sdist", ROOT, output, dated)
        yield sources
        with tarfile.open(sources) as archive:
            archive.extraction_filter = getattr(tarfile, "data_filter", None)  # which Python 3.11.3 has not
            archive.extractall(place)
        tree = Path(place, sources.name.removesuffix(".tar.gz"))
        for platform in PLATFORMS:
            yield build("wheel", tree, output, {**dated, "BOREPROP_PLATFORM": platform})


def build(target: str, tree: Path, output: Path, settings: Mapping[str, str]) -> Path:
    """Build one archive with hatchling from a tree of sources; what hatchling says is shown if it fails."""
    with TemporaryDirectory() as place:
        command = [sys.executable, "-m", "hatchling", "build", "--target", target, "--directory", place]
        done = subprocess.run(command, cwd=tree, env=os.environ | settings, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{target}: must be built by hatchling, got:\n{done.stdout}{done.stderr}")
        (made,) = Path(place).iterdir()
        return Path(shutil.move(made, output / made.name))


def commit_date() -> str:
    """When the commit was made, in seconds of Unix; `SOURCE_DATE_EPOCH` comes first, "" is hatchling's own date."""
    if named := os.environ.get("SOURCE_DATE_EPOCH"):
        return named
    if not (ROOT / ".git").exists() or not shutil.which("git"):
        return ""
    command = ["git", "-c", f"safe.directory={ROOT}", "log", "-1", "--format=%ct"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


if __name__ == "__main__":
    for archive in build_all(Path(*sys.argv[1:2] or ["dist"])):
        content = archive.read_bytes()
        print(f"{archive}\n    {len(content) / 1e6:.2f} MB, sha256 {sha256(content).hexdigest()}", flush=True)
