"""Compiles the kernel and the native FMU while the package is built, if it can; without a compiler all goes on."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import platform_tags


class CompilingHook(BuildHookInterface[Any]):
    """An editable installation has the libraries beside their sources, a wheel in itself."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say so; what then has the library in it is a wheel for this platform only."""
        sys.path[:0] = [str(Path(self.root, folder)) for folder in ("model", "fmu_build")]
        from boreprop.kernel.compiler import CompilerError, build_library, library_path
        from boreprop_fmu.native.binaries import BINARIES, build_binaries

        self.folder = TemporaryDirectory()
        editable = version == "editable"
        folder = Path(self.folder.name)
        made = {}
        try:
            library = build_library(library_path() if editable else folder / library_path().name)
            made[str(library)] = f"boreprop/kernel/{library.name}"
            self.app.display_info(f"The kernel is compiled: {library.name}")
            for binary in build_binaries(folder=BINARIES if editable else folder):
                made[str(binary)] = f"boreprop_fmu/binaries/{binary.parent.name}/{binary.name}"
                self.app.display_info(f"The native FMU is compiled: {binary.parent.name}")
        except (CompilerError, OSError) as error:
            what = "native FMU is not compiled, FMUs need Python" if made else "kernel is not compiled, Python does all"
            self.app.display_warning(f"The {what}: {error}")
        if made and not editable:
            build_data["force_include"] |= made
            build_data["pure_python"] = False
            platform = next(tag for tag in platform_tags() if not tag.startswith(("manylinux", "musllinux")))
            build_data["tag"] = f"py3-none-{platform}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Leave nothing behind."""
        self.folder.cleanup()
