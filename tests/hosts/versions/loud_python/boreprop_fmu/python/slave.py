"""Another version: every Real output is shown ten times as large."""

from boreprop_fmu.python.slave_before import Borehole as BoreholeBefore


class Borehole(BoreholeBefore):
    def get_real(self, vrs):
        values = super().get_real(vrs)
        is_output = [self._scalars[reference][1].role == "output" for reference in vrs]
        return [10 * value if loud else value for value, loud in zip(values, is_output, strict=True)]
