"""What film grammar must not depend on: where a mission is, which way round it is, and when it looks."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.registry import registry
from shotc.spec.fields import GRAMMAR
from tests.support.front_passes import resolved
from tests.support.grammar_missions import mission

pytestmark = pytest.mark.slow

SIDES = {"left": "right", "right": "left"}
Way = dict[str, object]


def written(name: str, way: Way, start: float, shift: tuple[float, float], mirror: bool) -> str:
    timing = f"timing: {{start: {start}, duration: {way['lasts']}}}"
    if way["kind"] == "lateral":
        side = SIDES[str(way["side"])] if mirror else way["side"]
        return (
            f"id: {name}, kind: lateral, target: runner, side: {side}, distance: {way['distance']}, "
            f"altitude: 4, {timing}"
        )
    x, y = (way["x"], way["y"])
    assert isinstance(x, float)
    assert isinstance(y, float)
    x = (-x if mirror else x) + shift[0]
    return f"id: {name}, kind: static, at: [{x}, {y + shift[1]}, 5], look_at: {way['of']}, {timing}"


def found(ways: list[Way], shift: tuple[float, float] = (0.0, 0.0), mirror: bool = False) -> list[str]:
    shots = [written(f"s{i}", way, 10.0 + 8 * i, shift, mirror) for i, way in enumerate(ways)]
    text = mission(*shots, shift=shift, mirror=mirror)
    said = [d for d in resolved(text)[1] if d.code.startswith("F")]
    return sorted(f"{d.code} line {d.labels[0].span.line}" for d in said)


lasts = st.sampled_from([1.0, 2.5, 5.0])
laterals = st.fixed_dictionaries(
    {
        "kind": st.just("lateral"),
        "side": st.sampled_from(["left", "right"]),
        "distance": st.sampled_from([4, 8, 11]),
        "lasts": lasts,
    }
)
statics = st.fixed_dictionaries(
    {
        "kind": st.just("static"),
        "x": st.integers(0, 17).map(lambda i: 5.0 * i + 0.3),
        "y": st.sampled_from([-21.3, -9.7, 12.4, 23.9]),
        "of": st.sampled_from(["runner", "statue"]),
        "lasts": lasts,
    }
)
films = st.lists(st.one_of(laterals, statics), min_size=2, max_size=5)


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(films)
def test_a_mirror_image_is_told_the_same(ways: list[Way]) -> None:
    assert found(ways, mirror=True) == found(ways)


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(films, st.integers(-9, 9), st.integers(-9, 9))
def test_a_mission_elsewhere_is_told_the_same(ways: list[Way], east: int, north: int) -> None:
    assert found(ways, shift=(64.0 * east, 64.0 * north)) == found(ways)


def test_what_may_be_allowed_is_the_family_of_film_grammar() -> None:
    assert set(GRAMMAR) == {info.slug for code, info in registry().items() if code.startswith("F")}
