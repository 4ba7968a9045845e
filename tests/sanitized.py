"""A plugin of pytest: FMUs for this machine are built by its own compiler, which obeys $CFLAGS."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from boreprop.kernel.compiler import compile_library, host_platform
from boreprop_fmu.pack import native


def compile_here(source: Path, output: Path, *, platform: str | None = None) -> Path:
    return compile_library(source, output, platform=None if platform == host_platform() else platform)


@pytest.fixture(autouse=True, scope="session")
def own_compiler() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(native, "compile_library", compile_here)
        yield
