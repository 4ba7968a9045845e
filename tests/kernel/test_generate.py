"""What is generated for C is fresh, and C that does not keep up with the table of quantities is refused."""

import ctypes
import shutil
from math import inf, isfinite
from pathlib import Path

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.case.parameters import parameters
from boreprop.core.checks import check_number
from boreprop.core.errors import ParameterError
from boreprop.core.quantities import OUTPUTS, Quantity, scalar_names
from boreprop.kernel import binding
from boreprop.kernel.binding import KernelError
from boreprop.kernel.compiler import FOLDER, CompilerError, NoCompilerError, compile_library, sources_digest
from boreprop.kernel.generate import HEADERS, SYSTEM, quantities_header


@pytest.mark.parametrize("name", HEADERS)
def test_the_generated_headers_are_fresh(name: str) -> None:
    assert (FOLDER / name).read_text(encoding="utf-8") == HEADERS[name](), "run: python -m boreprop.kernel.generate"


def compiled(folder: Path, outputs: tuple[Quantity, ...]) -> Path:
    """The kernel, compiled with a header for these outputs."""
    for path in [*FOLDER.glob("*.c"), *FOLDER.glob("*.h")]:
        shutil.copy(path, folder)
    (folder / "quantities.h").write_text(quantities_header(outputs=outputs), encoding="utf-8")
    digest = {"BOREPROP_SOURCES_DIGEST": f'"{sources_digest()}"'}
    try:
        return compile_library(folder / "library.c", folder / "boreprop_kernel.so", defines=digest)
    except NoCompilerError as error:
        pytest.skip(str(error))


def test_an_output_that_c_does_not_compute_is_an_error_of_the_compiler(tmp_path: Path) -> None:
    half_added = Quantity("sensor_inclination", "output", "rad", "", "", "inclination at the sensor", size="n-1")
    with pytest.raises(CompilerError, match="OUT_SENSOR_INCLINATION"):
        compiled(tmp_path, (*OUTPUTS, half_added))


def test_a_library_for_another_table_is_refused(tmp_path: Path) -> None:
    assert binding.load(compiled(tmp_path, OUTPUTS))
    (tmp_path / "other").mkdir()
    with pytest.raises(KernelError, match="must be made for this table of quantities"):
        binding.load(compiled(tmp_path / "other", OUTPUTS[::-1]))


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("quantity", SYSTEM, ids=lambda quantity: quantity.name)
def test_c_refuses_what_python_refuses_in_the_same_words(case: Case, quantity: Quantity) -> None:
    given = parameters(case) | {"relative_tolerance": 1e-7}
    name = quantity.names(2)[-1]
    bounds = {"above": quantity.above, "at_least": quantity.at_least, "at_most": quantity.at_most}
    outside = [quantity.above, quantity.at_least - 1e-9, quantity.at_most + 1e-9]
    for value in (inf, *filter(isfinite, outside)):
        why = ctypes.create_string_buffer(binding.MESSAGE)
        values = np.array([(given | {name: value})[scalar] for scalar in scalar_names(SYSTEM, 2)])
        inputs = binding.Inputs(rss_force=0.0, active_weight_on_bit=1e3)
        assert not binding.library().boreprop_start(2, values, 1, np.zeros(1), np.zeros(1), inputs, why)
        with pytest.raises(ParameterError) as refused:
            check_number(name, float(value), **bounds)
        assert why.value.decode() == str(refused.value)
