"""What the kernel refuses, number by number."""

import numpy as np
import pytest

from boreprop.case.case import Case
from boreprop.core.drilling import Drilling
from boreprop.core.errors import ParameterError
from boreprop.core.survey import Survey
from boreprop.core.system import BitRock, BottomHoleAssembly
from boreprop.kernel.binding import NativeDrilling

pytestmark = pytest.mark.usefixtures("kernel")


def test_each_number_of_a_state_counts(case: Case) -> None:
    """A state with one number changed is refused, or taken over with that number."""
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    run.advance(9.0, 300.0, 5e4)
    good = run.save()
    for where in range(60):
        changed = good.copy()
        changed[where] = np.nextafter(good[where], np.inf)
        try:
            run.restore(changed)
        except ParameterError:
            continue
        np.testing.assert_array_equal(run.save(), changed)


@pytest.mark.parametrize("number", [-2.0, 0.5])
def test_a_state_with_a_count_a_contact_or_a_part_that_cannot_be_is_refused(case: Case, number: float) -> None:
    """After its first number a state has ten whole ones, none of which is below −1."""
    run = NativeDrilling(case.bha, case.bit, case.survey, active_weight_on_bit=case.active_weight_on_bit)
    run.advance(9.0, 300.0, 5e4)
    for where in range(1, 11):
        forged = run.save()
        forged[where] = number
        with pytest.raises(ParameterError, match=r"^state: must be a valid saved state"):
            run.restore(forged)


def test_a_bha_too_long_for_a_double_is_refused_by_both_engines() -> None:
    bha, bit = BottomHoleAssembly((0.01, 1e307), (1e-3,), 0.0, 1.0, 1.0), BitRock(1.0, 0.1, 0.02)
    for engine in (Drilling, NativeDrilling):
        with pytest.raises(ParameterError) as refused:
            engine(bha, bit, Survey((0.0,), (0.0,)), active_weight_on_bit=1.0)
        ratio = "stabilizer_position[n] / stabilizer_position[1]"
        assert str(refused.value) == f"{ratio}: must be a finite number, got inf"
