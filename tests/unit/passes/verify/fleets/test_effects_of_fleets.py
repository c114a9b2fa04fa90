"""Shows flown with other effects of lights than their mission asks for: none of them is accepted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from shotc.ir.fleet import Lights
from shotc.ir.light_layers import Band, Glints, Gradient, Layer, Look
from shotc.ir.source import Chosen
from shotc.ir.trajectory import Claim
from shotc.lowering import lower
from tests.support.compiled import compiled_text
from tests.support.records import replace
from tests.support.verdicts import codes, verdict_on

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("effects-of-fleets")]

SHOW = """\
shotc: 1
mission: lantern
fleets:
  swarm: {count: 8, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone}
shots:
  - id: d
    kind: display
    fleet: swarm
    viewpoint: [0, -80, 2]
    frames:
      - sphere: {center: [0, 20, 30], radius: 8}
        hold: 6
        effects:
          - ramp: {colors: [red, gold], along: up}
          - {chase: {color: white, along: right, period: 3 s}, blend: add, over: hold}
          - {fade: {to: blue, time: 1 s}, over: transition}
      - cube: {center: [0, 20, 30], size: 12}
        hold: 4
        color: lime
        effects:
          - {ramp: {colors: [lime, blue], along: out, period: 2 s}, opacity: 80 %}
    effects:
      - {sparkle: {color: gold, share: 0.4}, from: 2 s, until: {frame: 1}, blend: screen, fade_in: 1 s}
      - {fade: {from: black, time: 2 s}}
"""
COUNT, COLORS, TIMES, PLACE = (
    "effects not as asked",
    "effect off its colours",
    "effect off its times",
    "effect off its place",
)
BETWEEN = "light between pictures"
OTHERS: dict[str, tuple[str, str, set[str]]] = {
    "another colour of a ramp": ("[red, gold]", "[red, lime]", {COLORS}),
    "colours the other way round": ("[red, gold]", "[gold, red]", {COLORS}),
    "one colour more": ("[red, gold]", "[red, gold, red]", {COUNT}),
    "colours at other places": ("along: up}", "along: up, at: [0.2, 1]}", {PLACE}),
    "another way": ("along: up}", "along: down}", {PLACE}),
    "a way of another kind": ("along: up}", "along: index}", {COUNT}),
    "a way by time": ("along: up}", "along: time}", {COUNT}),
    "from another middle": ("along: out,", "along: out, center: [4, 20, 30],", {PLACE}),
    "inwards": ("along: out,", "along: in,", {PLACE}),
    "a ramp that stands": (", period: 2 s", "", {COUNT}),
    "another period": ("period: 3 s", "period: 3.2 s", {TIMES}),
    "to the left": ("along: right", "along: left", {PLACE}),
    "a longer band": ("period: 3 s", "period: 3 s, length: 0.3", {PLACE}),
    "another blend": ("blend: add", "blend: lighten", {COUNT}),
    "another opacity": ("opacity: 80 %", "opacity: 40 %", {COLORS}),
    "at another time of the picture": ("over: hold", "over: transition", {TIMES}),
    "a shorter fade": ("{to: blue, time: 1 s}", "{to: blue, time: 0.5 s}", {TIMES}),
    "a fade the other way": ("{to: blue, time: 1 s}", "{from: blue, time: 1 s}", {TIMES}),
    "another effect": ("{to: blue, time: 1 s}", "{to: red, time: 1 s}", {COLORS}),
    "another kind of effect": ("{fade: {to: blue, time: 1 s}", "{sparkle: {color: blue}", {COUNT}),
    "more sparkles": ("share: 0.4", "share: 0.5", {PLACE}),
    "faster sparkles": ("share: 0.4", "share: 0.4, period: 0.5 s", {TIMES}),
    "2 s later": ("from: 2 s", "from: 4 s", {TIMES}),
    "a picture longer": ("until: {frame: 1}", "until: {frame: 2}", {TIMES}),
    "faded in faster": ("fade_in: 1 s", "fade_in: 0.5 s", {TIMES}),
    "none": ("      - {fade: {from: black, time: 2 s}}\n", "", {COUNT}),
    "one more": ("    effects:\n      - {s", "    effects:\n      - fade: {to: black}\n      - {s", {COUNT}),
    "in another order": (
        "          - {chase: {color: white, along: right, period: 3 s}, blend: add, over: hold}\n"
        "          - {fade: {to: blue, time: 1 s}, over: transition}\n",
        "          - {fade: {to: blue, time: 1 s}, over: transition}\n"
        "          - {chase: {color: white, along: right, period: 3 s}, blend: add, over: hold}\n",
        {COUNT},
    ),
    "seen from another place": ("viewpoint: [0, -80, 2]", "viewpoint: [80, 0, 2]", {PLACE}),
}
"""The text of the mission, another one, and the claims that the flight breaks then."""


def certificate(text: str) -> dict[str, Claim]:
    """Return the claims about the flight of the show under the mission of another text."""
    plan, keyframes = compiled_text(SHOW).plan, lower(text.encode(), "show.yaml", None, Chosen()).keyframes
    assert plan is not None
    assert keyframes is not None
    return {c.constraint: c for c in verdict_on(replace(plan.trajectory, keyframes=keyframes)).certificate}


def lights() -> Lights:
    """Return the lights of the show as they are planned."""
    plan = compiled_text(SHOW).plan
    assert plan is not None
    return plan.trajectory.fleets[0].lights


def broken(edited: Lights) -> set[str]:
    """Return the claims that the show breaks with other lights."""
    plan = compiled_text(SHOW).plan
    assert plan is not None
    fleets = (replace(plan.trajectory.fleets[0], lights=edited),)
    verdict = verdict_on(replace(plan.trajectory, fleets=fleets))
    return {c.constraint for c in verdict.certificate if not c.holds}


def with_paint(edit: Callable[[Any], Any], kind: type) -> Lights:
    """Return the lights of the show with the paint of one kind edited, wherever it is."""

    def changed(layer: Layer) -> Layer:
        return layer._replace(paint=edit(layer.paint)) if isinstance(layer.paint, kind) else layer

    known = lights()
    looks = tuple(Look(tuple(map(changed, look.layers)), look.spare) for look in known.looks)
    return replace(known, looks=looks, over=tuple(map(changed, known.over)))


def test_the_show_holds_and_says_so() -> None:
    found = certificate(SHOW)
    assert all(c.holds for c in found.values())
    assert {COUNT, COLORS, TIMES, PLACE, BETWEEN} <= found.keys()
    assert found[PLACE].worst < 1e-6


@pytest.mark.parametrize("name", OTHERS)
def test_an_effect_that_is_not_asked_for_is_refused(name: str) -> None:
    old, new, claims = OTHERS[name]
    changed = SHOW.replace(old, new, 1)
    assert changed != SHOW
    found = certificate(changed)
    assert {c for c in (COUNT, COLORS, TIMES, PLACE, BETWEEN) if c in found and not found[c].holds} >= claims


def test_the_line_of_the_effect_is_shown() -> None:
    found = certificate(SHOW.replace("from: 2 s", "from: 4 s"))[TIMES]
    assert found.path == ("shots", 0, "effects", 0)
    assert (found.worst, found.limit) == (pytest.approx(2.0), 1e-3)


def test_a_plan_with_another_effect_is_refused_by_code() -> None:
    plan = compiled_text(SHOW).plan
    assert plan is not None
    edited = with_paint(lambda paint: paint._replace(color=(1, 2, 3)), Band)
    assert broken(edited) == {COLORS}
    assert codes(replace(plan.trajectory, fleets=(replace(plan.trajectory.fleets[0], lights=edited),))) == [
        "V064"
    ]


def test_which_lights_sparkle_is_left_open() -> None:
    assert broken(with_paint(lambda paint: paint._replace(seed=paint.seed + 1), Glints)) == set()


def test_an_effect_that_runs_from_another_time_is_refused() -> None:
    assert broken(with_paint(lambda paint: paint._replace(origin=paint.origin + 2.0), Band)) == {TIMES}
    assert TIMES in broken(with_paint(lambda paint: paint._replace(rate=-paint.rate), Gradient))


def test_effects_that_are_never_shown_are_missing() -> None:
    known = lights()
    assert COUNT in broken(replace(known, looks=(), of=(), over=()))
    assert COUNT in broken(replace(known, looks=(), of=(), over=known.over))
    assert COUNT in broken(replace(known, of=(-1,) * len(known.of)))
    assert COUNT in broken(replace(known, of=tuple(min(look, 0) for look in known.of)))


def test_lights_shine_neither_on_the_way_up_nor_on_the_way_down() -> None:
    known = lights()
    for end in (0, -1):
        colors = known.colors.copy()
        colors[2, end] = 40
        assert broken(replace(known, colors=colors)) == {BETWEEN}
    assert BETWEEN in broken(replace(known, of=tuple(max(look, 0) for look in known.of)))


def test_a_flash_between_two_pictures_is_refused() -> None:
    known = lights()
    times = np.insert(known.times, 3, 0.5 * (known.times[2] + known.times[3]))
    of = (*known.of[:3], known.of[2], *known.of[3:])
    flash = np.insert(known.colors, 3, 255, axis=1)
    assert BETWEEN in broken(replace(known, times=times, colors=flash, of=of))
    assert BETWEEN in broken(Lights(times, flash))
