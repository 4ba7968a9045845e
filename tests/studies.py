"""What several tests of studies need."""

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
import scipy.stats

UNCERTAIN = {
    "active_weight_on_bit": scipy.stats.norm(1600.0, 300.0),
    "stabilizer_clearance[1]": scipy.stats.lognorm(0.3, scale=3e-3),
}


@pytest.fixture
def thread() -> Any:
    """An executor whose functions need not be importable."""
    with ThreadPoolExecutor(1) as executor:
        yield executor
