from math import inf, nan, pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.units import ANGULAR, EXAMPLES, LARGEST, SMALLEST, UNITS, QuantityError, parse_quantity

DIMENSIONS = st.sampled_from(list(UNITS))
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=80),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@pytest.mark.parametrize(
    ("value", "dimension", "expected"),
    [
        (3, "length", 3.0),
        (-2.5, "length", -2.5),
        ("12 m", "length", 12.0),
        ("12m", "length", 12.0),
        ("  12  m ", "length", 12.0),
        ("13.2 mm", "length", 0.0132),
        ("4 cm", "length", 0.04),
        ("1.5 km", "length", 1500.0),
        ("100 ft", "length", 30.48),
        ("+.5 m", "length", 0.5),
        ("2. m", "length", 2.0),
        ("1e2 m", "length", 100.0),
        ("20 s", "duration", 20.0),
        ("250 ms", "duration", 0.25),
        ("20 min", "duration", 1200.0),
        ("1.5 h", "duration", 5400.0),
        ("8 m/s", "speed", 8.0),
        ("36 km/h", "speed", 10.0),
        ("36 kmh", "speed", 10.0),
        ("10 kn", "speed", 5.144444444444445),
        ("10 kt", "speed", 5.144444444444445),
        ("10 mph", "speed", 4.4704),
        ("10 ft/s", "speed", 3.048),
        ("3 m/s^2", "acceleration", 3.0),
        ("3 m/s²", "acceleration", 3.0),
        ("8 m/s^3", "jerk", 8.0),
        ("8 m/s³", "jerk", 8.0),
        ("180 deg", "angle", pi),
        ("-90°", "angle", -pi / 2),
        ("1.5 rad", "angle", 1.5),
        ("60 deg/s", "angular rate", radians(60)),
        ("90 deg/s^2", "angular acceleration", radians(90)),
        ("100 %", "ratio", 1.0),
        (0.8, "ratio", 0.8),
        ("50 Hz", "frequency", 50.0),
    ],
)
def test_quantities_people_write(value, dimension, expected):
    assert parse_quantity(value, dimension) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("value", "dimension", "kind", "words"),
    [
        ("8 furlong", "length", "unknown-unit", "`furlong`"),
        ("3 m/sec", "speed", "unknown-unit", "did you mean `m/s`?"),
        ("5 meters", "length", "unknown-unit", "did you mean `m`?"),
        ("5 KM/H", "speed", "unknown-unit", "did you mean `km/h`?"),
        ("5 knots", "speed", "unknown-unit", "did you mean `kn`?"),
        ("2 g", "acceleration", "wrong-dimension", "m/s^2"),
        ("8 s", "speed", "wrong-dimension", "expected a speed, got a duration"),
        ("8 m", "angle", "wrong-dimension", "expected an angle, got a length"),
        ("8 deg", "angular rate", "wrong-dimension", "expected an angular rate, got an angle"),
        (45, "angle", "bare-angle", "an angle needs a unit write `45 deg`"),
        (1.5, "angle", "bare-angle", "`1.5 deg`, or `1.5 rad` if radians are meant"),
        (0, "angle", "bare-angle", "`0 deg`"),
        (-inf, "angle", "bare-angle", "write an angle such as `45 deg`"),
        ("45", "angle", "bare-angle", "`45 deg`"),
        (60, "angular rate", "bare-angle", "deg/s"),
        ("8", "length", "missing-unit", "`8 m`"),
        ("fast", "speed", "not-a-quantity", "the text `fast`"),
        ("1 min 30 s", "duration", "not-a-quantity", "`20 s`"),
        ("1,5 m", "length", "not-a-quantity", "`1.5 m`"),
        ("9**9**9", "length", "not-a-quantity", "`9**9**9`"),
        ("1,5m", "length", "not-a-quantity", "`1.5m`"),
        ("", "length", "not-a-quantity", "a length"),
        (True, "length", "not-a-quantity", "true or false"),
        (None, "length", "not-a-quantity", "nothing"),
        ([1], "length", "not-a-quantity", "a list"),
        ({"m": 1}, "length", "not-a-quantity", "a mapping"),
        (nan, "length", "absurd-value", "`nan`"),
        (inf, "speed", "absurd-value", "1000 m/s"),
        (1e300, "speed", "absurd-value", "`1e+300`"),
        (10**400, "length", "absurd-value", "100000 m"),
        ("1e999 m", "length", "absurd-value", "100000 m"),
        ("-2e5 m", "length", "absurd-value", "100000 m"),
        ("1e6 deg", "angle", "absurd-value", "1000 rad"),
    ],
)
def test_faults_name_what_is_wrong(value, dimension, kind, words):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(value, dimension)
    assert caught.value.kind == kind
    assert words in f"{caught.value.message} {caught.value.help}"


@given(st.floats(-1e6, 1e6))
def test_radians_are_proposed_for_an_angle_only_within_a_turn(value):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(value, "angle")
    assert ("rad`" in caught.value.help) is (abs(value) <= 2 * pi)
    assert not caught.value.message.endswith(".")


def test_no_unit_belongs_to_two_dimensions():
    every = [unit for units in UNITS.values() for unit in units]
    assert len(every) == len(set(every))


def test_every_dimension_has_bounds_and_an_example():
    assert set(UNITS) == set(LARGEST) == set(SMALLEST) == set(EXAMPLES)
    for dimension, example in EXAMPLES.items():
        assert SMALLEST[dimension] < parse_quantity(example, dimension) < LARGEST[dimension]


@pytest.mark.slow
@given(DIMENSIONS, st.data())
def test_every_unit_is_its_factor(dimension, data):
    unit, (times, over) = data.draw(st.sampled_from(list(UNITS[dimension].items())))
    factor = times / over
    most = LARGEST[dimension] / factor * 0.999
    number = data.draw(st.floats(-most, most, allow_subnormal=False))
    space = data.draw(st.sampled_from(["", " ", "  "]))
    assert parse_quantity(f"{number!r}{space}{unit}", dimension) == pytest.approx(number * factor, rel=1e-12)


@pytest.mark.slow
@given(st.sampled_from([d for d in UNITS if d not in ANGULAR]), st.floats(-1000, 1000))
def test_a_bare_number_is_si(dimension, number):
    base, (_, over) = next((u, scale) for u, scale in UNITS[dimension].items() if scale[0] == 1.0)
    written = f"{number * over!r} {base}"
    assert parse_quantity(number, dimension) == pytest.approx(parse_quantity(written, dimension), rel=1e-12)


@pytest.mark.slow
@given(JSON, DIMENSIONS)
def test_anything_is_a_bounded_number_or_a_fault(value, dimension):
    try:
        number = parse_quantity(value, dimension)
    except QuantityError as error:
        fault = error
    else:
        assert abs(number) <= LARGEST[dimension]
        return
    assert fault.message
    assert "\n" not in fault.message + fault.help
