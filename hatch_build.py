"""Compiles the kernel and the native FMU while the package is built, and makes its description of the README.

An installation compiles them for its own machine if it can; without a compiler all goes on. With a platform in
`BOREPROP_PLATFORM` (linux64, win64, …) ziglang compiles, or the build fails: a wheel for that platform, on whatever
machine it is built, with the FMU's binaries for all platforms in it. `build_wheels.py` does that for each.
"""

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface
from packaging.tags import platform_tags


class CompilingHook(BuildHookInterface[Any]):
    """An editable installation has the libraries beside their sources, a wheel in itself."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say so; what then has the library in it is a wheel for one platform only."""
        sys.path[:0] = [str(Path(self.root, folder)) for folder in ("model", "fmu_build")]
        from boreprop.errors import BorepropError
        from boreprop.kernel.compiler import PLATFORMS

        self.folder = TemporaryDirectory()
        editable = version == "editable"
        platform = None if editable else os.environ.get("BOREPROP_PLATFORM")
        made = {}
        try:
            for library, place in self.compile(platform, editable):
                made[str(library)] = place
                self.app.display_info(f"Compiled: {place}")
        except (BorepropError, OSError) as error:
            if platform:
                raise
            what = "native FMU is not compiled, FMUs need Python" if made else "kernel is not compiled, Python does all"
            self.app.display_warning(f"The {what}: {error}")
        if made and not editable:
            build_data["force_include"] |= made
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{PLATFORMS[platform].tag if platform else own_tag()}"

    def compile(self, platform: str | None, editable: bool) -> Iterator[tuple[Path, str]]:
        """Compile the kernel for a platform and the FMU for all, or both for this machine.

        Yields
        ------
        Each library as soon as it is there, and where it is in a wheel.
        """
        from boreprop.kernel.compiler import build_library, library_path
        from boreprop_fmu.native.binaries import BINARIES, PLATFORMS, build_binaries, check_platform

        if platform:
            check_platform(platform)
        folder = Path(self.folder.name)
        library = build_library(library_path() if editable else folder / library_path(platform).name, platform)
        yield library, f"boreprop/kernel/{library.name}"
        for binary in build_binaries(PLATFORMS if platform else (), BINARIES if editable else folder):
            yield binary, f"boreprop_fmu/binaries/{binary.parent.name}/{binary.name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Leave nothing behind."""
        self.folder.cleanup()


def own_tag() -> str:
    """The platform of a wheel with what is compiled for this machine by its own compiler."""
    return next(tag for tag in platform_tags() if not tag.startswith(("manylinux", "musllinux")))


class DescribingHook(MetadataHookInterface):
    """On a package index the README stands without the files beside it: what leads to them is left out."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Give the README without its pictures and their captions, its list of pages, and its links to files."""
        text = Path(self.root, "README.md").read_text(encoding="utf-8")
        text = re.sub(r"^!\[.*\n\n\*.*\*\n\n", "", text, flags=re.MULTILINE)
        text = re.sub(r"^## Documentation\n(?:\n|[`|].*\n)*", "", text, flags=re.MULTILINE)
        text = re.sub(r"\[([^]]+)\]\((?!\w+://)[^)]+\)", r"\1", text)
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
