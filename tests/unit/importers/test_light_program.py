"""Light programs of Skybrush: what they show when, and what is none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.importers.flights.light_program import KeyedLight, keyed
from shotc.importers.flights.points import Unread
from shotc.show.emit.skyc.light_programs import program


def color_at(light: KeyedLight, time: float) -> tuple[float, ...]:
    """The colour at a time, straight between those that are told."""
    before = max((i for i, t in enumerate(light.times) if t <= time), default=0)
    if before + 1 == len(light.times):
        return light.colors[before]
    a, b = light.times[before : before + 2]
    share = (time - a) / (b - a)
    one, other = light.colors[before : before + 2]
    return tuple(x + share * (y - x) for x, y in zip(one, other, strict=True))


ORDERS = {
    "a colour for a second, and another": (bytes([4, 255, 0, 0, 50, 4, 0, 0, 255, 50, 0]),
                                           {0.5: (255, 0, 0), 1.0: (0, 0, 255), 5.0: (0, 0, 255)}),
    "a fade": (bytes([7, 0, 8, 0, 0, 0, 100, 1, 0]), {0.0: (255,) * 3, 1.0: (127.5,) * 3, 2.0: (0, 0, 0)}),
    "grey, sleep, black": (bytes([5, 80, 10, 2, 40, 6, 1, 0]), {0.9: (80,) * 3, 1.0: (0, 0, 0)}),
    "fades to grey, white and black": (bytes([9, 100, 50, 11, 50, 10, 50, 0]),
                                       {1.0: (100,) * 3, 2.0: (255,) * 3, 3.0: (0,) * 3}),
    "a loop of three": (bytes([12, 3, 4, 9, 9, 9, 25, 6, 25, 13, 7, 1, 0]),
                        {0.2: (9,) * 3, 0.7: (0,) * 3, 2.2: (9,) * 3, 2.7: (0,) * 3, 3.01: (255,) * 3}),
    "a long time": (bytes([4, 1, 2, 3, 0xAC, 2, 6, 1, 0]), {5.99: (1, 2, 3), 6.0: (0, 0, 0)}),
    "a loop without an end": (bytes([12, 0, 7, 25, 6, 25, 13, 0]), {60.2: (255,) * 3, 60.7: (0,) * 3}),
}  # fmt: skip


@pytest.mark.parametrize("name", ORDERS)
def test_orders_do_what_they_say(name: str) -> None:
    code, seen = ORDERS[name]
    light = keyed(code, "a", 100.0)
    assert list(light.times) == sorted(set(light.times))
    for time, color in seen.items():
        assert color_at(light, time) == pytest.approx(color, abs=1e-6)


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (bytes([4, 1, 2]), "breaks off after 3 bytes"),
        (bytes([7, 255, 255, 255, 255, 255, 1, 0]), "more than 28 bits"),
        (bytes([0x12, 0]), "an order 0x12 at byte 0"),
        (bytes([13, 0]), "ends a loop at byte 0"),
        (bytes([12, 0, 1, 13, 0]), "more than 100000 orders"),
    ],
)
def test_what_is_no_program_is_told(code: bytes, said: str) -> None:
    with pytest.raises(Unread) as stopped:
        keyed(code, "the light", 100.0)
    assert said in stopped.value.refused.message


@given(st.binary(max_size=30))
def test_no_bytes_make_a_traceback(code: bytes) -> None:
    try:
        light = keyed(code, "a", 10.0)
    except Unread:
        return
    assert all(0 <= part <= 255 for color in light.colors for part in color)


COLORS = st.tuples(st.integers(0, 255), st.integers(0, 255), st.integers(0, 255))


@pytest.mark.slow
@given(st.lists(st.tuples(st.integers(1, 300), COLORS), min_size=1, max_size=8))
def test_what_we_write_is_read(steps: list[tuple[int, tuple[int, int, int]]]) -> None:
    at, colors = [0], [(0, 0, 0)]
    for wait, color in steps:
        at.append(at[-1] + wait)
        colors.append(color)
    light = keyed(program(at, [bytes(color) for color in colors]), "a", 1e4)
    for step, color in zip(at, colors, strict=True):
        assert color_at(light, step * 0.02) == pytest.approx(color, abs=1e-6)
