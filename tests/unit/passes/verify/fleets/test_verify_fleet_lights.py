"""The lights of a show while its pictures stand: colours, and how many are dark."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from shotc.ir.fleet import Lights
from shotc.ir.light_layers import FadeTimes, Layer, Look, Tint
from shotc.ir.show import Drawing
from shotc.ir.trajectory import Claim, TrajectoryIR
from tests.support.records import replace
from tests.support.show_plans import display, mission, show
from tests.support.verdicts import codes, verdict_on

OFF, DARK = "light off its colour", "dark lights of a picture"
SHOW = show()
"""White from 16 to 20 s, orange from 26 to 28 s, four drones."""


def with_lights(lights: Lights, ir: TrajectoryIR = SHOW) -> TrajectoryIR:
    return replace(ir, fleets=(replace(ir.fleets[0], lights=lights),))


def edited(edit: Callable[[np.ndarray], None], ir: TrajectoryIR = SHOW) -> TrajectoryIR:
    lights = ir.fleets[0].lights
    colors = lights.colors.copy()
    edit(colors)
    return with_lights(replace(lights, colors=colors), ir)


def claims(ir: TrajectoryIR) -> dict[str, Claim]:
    return {c.constraint: c for c in verdict_on(ir).certificate}


def asking(**changes: object) -> TrajectoryIR:
    first, second = display().pictures
    return show(mission(displays=(display()._replace(pictures=(first._replace(**changes), second)),)))


def test_a_picture_in_another_colour_is_refused() -> None:
    ir = asking(color=(255, 0, 0))
    found = claims(ir)[OFF]
    assert (found.worst, found.holds, found.time) == (255.0, False, 16.0)
    assert found.path == ("shots", 0, "frames", 0, "color")
    assert "V064" in codes(ir)


@pytest.mark.parametrize(("by", "holds"), [(1, True), (2, False)])
def test_rounding_of_a_level_is_no_other_colour(by: int, holds: bool) -> None:
    def darker(colors: np.ndarray) -> None:
        colors[2, 2] -= by

    found = claims(edited(darker))[OFF]
    assert (found.worst, found.holds, found.drones) == (by, holds, ("swarm-3",))


def test_a_light_that_goes_out_while_its_picture_stands_is_off_its_colour() -> None:
    lights = SHOW.fleets[0].lights
    colors = np.insert(lights.colors, 2, 0, axis=1)
    out = with_lights(Lights(np.insert(lights.times, 2, 18.0), colors))
    assert claims(out)[OFF].worst == 255.0


def test_a_picture_of_dark_lights_is_refused() -> None:
    def dark(colors: np.ndarray) -> None:
        colors[:, 3:5] = 0

    found = claims(edited(dark))[DARK]
    assert (found.worst, found.limit, found.holds) == (1.0, 0.75, False)

    def but_one(colors: np.ndarray) -> None:
        colors[1:, 3:5] = 0

    assert claims(edited(but_one))[DARK].holds


def test_black_is_a_colour_that_may_be_asked() -> None:
    def dark(colors: np.ndarray) -> None:
        colors[:, 1:3] = 0

    found = claims(edited(dark, asking(color=(0, 0, 0))))
    assert found[OFF].holds
    assert found[DARK].holds
    assert not claims(asking(color=(0, 0, 0)))[OFF].holds


def test_the_colours_of_a_file_are_not_judged_but_its_darkness_is() -> None:
    ir = asking(source=Drawing("heart.svg", (6.0, 20.0, 30.0), 10.0, 0.0))
    second_alone = claims(ir)[OFF]
    assert second_alone.time == 26.0

    def dark(colors: np.ndarray) -> None:
        colors[:, 1:3] = 0

    assert not claims(edited(dark, ir))[DARK].holds


def test_with_effects_drones_that_a_picture_leaves_out_are_dark_and_all_others_are_not() -> None:
    layer = Layer(Tint((0, 0, 255)), "mix", 1.0, FadeTimes(16.0, 16.0, 20.0, 20.0))
    looks = (Look((layer,), (3,)), Look((), ()))
    lights = replace(SHOW.fleets[0].lights, looks=looks, of=(-1, 0, 0, 1, 1, -1))
    assert claims(with_lights(lights))[OFF].drones == ("swarm-4",)
    colors = lights.colors.copy()
    colors[3, 1:3] = 0
    found = claims(with_lights(replace(lights, colors=colors)))
    assert found[OFF].holds
    assert found[DARK].worst == 0.25
    none = replace(lights, looks=(Look((layer,), (0, 1, 2, 3)), Look((), ())))
    assert claims(with_lights(none))[DARK].worst == 1.0
