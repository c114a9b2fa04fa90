"""Numbers rounded to one side: enough, no more than a digit off, and themselves where they are exact."""

from decimal import Decimal
from math import copysign, isclose, nextafter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.rounding import EXACT_SHARE, at_least, at_most, down, plain, rounded_outward, up

values = st.floats(-1e5, 1e5)
digits = st.integers(0, 4)


@given(value=values, digits=digits)
def test_a_number_rounded_up_is_enough_and_the_least_of_its_decimals(value, digits):
    step = 10.0**-digits
    told = up(value, digits)
    assert told >= value - 1.01 * EXACT_SHARE * step
    assert told - value < step * (1 + 1e-6)
    assert told == float(at_least(value, digits))


@given(value=values, digits=digits)
def test_down_is_up_from_the_other_side(value, digits):
    assert down(value, digits) == -up(-value, digits)
    assert down(value, digits) == float(at_most(value, digits))
    assert copysign(1.0, down(value, digits) or 0.0) == copysign(1.0, down(value, digits))


@pytest.mark.slow
@given(count=st.integers(-(10**9), 10**9), digits=digits, steps=st.integers(-8, 8))
def test_a_decimal_stays_itself_though_arithmetic_has_moved_its_last_bits(count, digits, steps):
    exact = float(Decimal(count).scaleb(-digits))
    moved = exact
    for _ in range(abs(steps)):
        moved = nextafter(moved, steps * float("inf"))
    if abs(moved - exact) * 10**digits < EXACT_SHARE / 2:
        assert up(moved, digits) == down(moved, digits) == exact


def test_what_means_three_is_three_and_what_is_more_is_more():
    assert at_least(3.0000000001) == at_most(2.9999999999) == "3.00"
    assert (at_least(3.000001), at_most(2.999999)) == ("3.01", "2.99")
    assert (at_least(0.1 + 0.2, 1), at_least(-0.004), at_most(0.004)) == ("0.3", "0.00", "0.00")
    assert (at_least(12.3, 0), at_most(12.3, 0)) == ("13", "12")


@given(value=st.floats(1e-6, 1e6), upper=st.booleans(), digits=st.integers(2, 6))
def test_significant_digits_are_rounded_away_from_a_value(value, upper, digits):
    told = rounded_outward(value, upper=upper, digits=digits)
    assert isclose(told, value, rel_tol=10.0 ** (1 - digits))
    assert (told - value) * (1 if upper else -1) >= -2 * EXACT_SHARE * 10.0 ** (1 - digits) * value
    assert rounded_outward(-value, upper=not upper, digits=digits) == -told


def test_significant_digits_of_nothing_and_of_large_numbers():
    assert rounded_outward(0.0, upper=True, digits=4) == 0.0
    assert (
        rounded_outward(123456.0, upper=True, digits=4),
        rounded_outward(123456.0, upper=False, digits=4),
    ) == (123500, 123400)


@pytest.mark.parametrize(
    ("value", "text"), [(4.0, "4"), (4.25, "4.25"), (1 / 3, "0.333"), (120.0, "120"), (0.0, "0")]
)
def test_plain_numbers_are_as_short_as_they_were_written(value, text):
    assert plain(value) == text
