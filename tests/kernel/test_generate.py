"""The headers that repeat numbers of the core."""

import pytest

from boreprop.kernel.compiler import FOLDER
from boreprop.kernel.generate import HEADERS


@pytest.mark.parametrize("name", HEADERS)
def test_a_generated_header_is_as_it_would_be_generated_now(name: str) -> None:
    assert (FOLDER / name).read_text(encoding="utf-8") == HEADERS[name]()
