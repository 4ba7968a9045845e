"""Amounts with units, as people write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from boreprop.units import WRITTEN, read_amounts

UNITS_OF_A_KIND = [(unit, si) for units in WRITTEN for si in units if si and units[si] == 1.0 for unit in units]


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [  # from handbooks, to the digits that they print
        ("8.5 in", "mm", 215.9),
        ("12.25in", "m", 0.31115),
        ("6 3/4 in", "mm", 171.45),
        ("6-3/4 in", "mm", 171.45),
        ("6¾″", "mm", 171.45),
        ("¾ in", "mm", 19.05),
        ("1/32 in", "mm", 0.79375),
        ("4/32in", "mm", 3.175),
        ("30 ft", "m", 9.144),
        ("10 ppg", "kg/m³", 1198.264),
        ("1.25 SG", "kg/m3", 1250.0),
        ("62.4 pcf", "kg/m³", 999.5521),
        ("30 klbf", "N", 133446.6),
        ("133 kN", "N", 133e3),
        ("10 t", "N", 98066.5),
        ("−1.5e1 kN", "N", -15e3),
        ("180 deg", "rad", 3.14159265),
        ("-3 °", "°", -3.0),
        ("40 %", "", 0.4),
        ("60e3", "N", 60e3),
        (".5", "m", 0.5),
    ],
)
def test_amounts_as_people_write_them(text: str, unit: str, expected: float) -> None:
    assert read_amounts(text, unit) == pytest.approx((expected,), rel=1e-6)


def test_a_unit_holds_for_the_numbers_before_it() -> None:
    assert read_amounts("10, 20; 30 ft", "m") == pytest.approx((3.048, 6.096, 9.144))
    assert read_amounts("1 m, 10 ft", "m") == pytest.approx((1.0, 3.048))
    assert read_amounts("3.66,7.32", "m") == (3.66, 7.32)


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("", "m"),
        ("in", "m"),
        ("8.5 kg", "m"),
        ("8.5 in", "N"),
        ("8 1/0 in", "m"),
        ("8.5.1", "m"),
        ("3 in 4", "m"),
        ("6 3/4 × 2", "in"),
        ("12 ft, 41", "m"),
        ("1,,2", "m"),
        ("1e999", "m"),
        ("1e99999999999", "m"),
        ("nan", "m"),
        ("inf", "m"),
        ("9" * 5000, "m"),
        ("9" * 400 + "/1 in", "m"),
    ],
)
def test_anything_else_is_no_amount(text: str, unit: str) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 - the caller says what it wants
        read_amounts(text, unit)


@pytest.mark.parametrize(("unit", "si"), UNITS_OF_A_KIND)
@given(value=st.floats(1e-6, 1e6))
def test_to_a_unit_and_back(unit: str, si: str, value: float) -> None:
    (there,) = read_amounts(f"{value!r} {si}", unit)
    assert read_amounts(f"{there!r} {unit}", si) == pytest.approx((value,), rel=1e-14)


@given(whole=st.integers(0, 40), above=st.integers(0, 63), below=st.sampled_from([2, 4, 8, 16, 32, 64]))
def test_a_fraction_is_its_decimal_number(whole: int, above: int, below: int) -> None:
    decimal = read_amounts(f"{whole + above / below} in", "m")
    assert (
        read_amounts(f"{whole} {above}/{below} in", "m") == read_amounts(f"{whole}-{above}/{below}in", "m") == decimal
    )


@given(text=st.text(alphabet="0123456789 /.,;-+e¼inftmkNg%°\"'", max_size=20))
def test_a_text_is_finite_amounts_or_a_value_error(text: str) -> None:
    try:
        amounts = read_amounts(text, "m")
    except ValueError:
        return
    assert amounts
    assert all(abs(amount) < float("inf") for amount in amounts)
