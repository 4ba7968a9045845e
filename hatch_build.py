"""Compiles the kernel while the package is built, if there is something to compile it with; without it all goes on."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import platform_tags


class KernelHook(BuildHookInterface[Any]):
    """An editable installation has the library beside its sources, a wheel in itself."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and say so; what then has the library in it is a wheel for this platform only."""
        spec = spec_from_file_location("compiler", Path(self.root, "model", "boreprop", "kernel", "compiler.py"))
        assert spec
        assert spec.loader
        compiler = module_from_spec(spec)
        spec.loader.exec_module(compiler)
        self.folder = TemporaryDirectory()
        library = compiler.library_path()
        if version != "editable":
            library = Path(self.folder.name, library.name)
        try:
            compiler.build_library(library)
        except (compiler.CompilerError, OSError) as error:
            self.app.display_warning(f"The kernel is not compiled, Python does all: {error}")
            return
        self.app.display_info(f"The kernel is compiled: {library.name}")
        if version != "editable":
            build_data["force_include"][str(library)] = f"boreprop/kernel/{library.name}"
            build_data["pure_python"] = False
            platform = next(tag for tag in platform_tags() if not tag.startswith(("manylinux", "musllinux")))
            build_data["tag"] = f"py3-none-{platform}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        """Leave nothing behind."""
        self.folder.cleanup()
