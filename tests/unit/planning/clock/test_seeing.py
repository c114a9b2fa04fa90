"""Ways between placed keyframes on the clock: led to where the target is seen, and otherwise as they were."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.keyed import place_of
from shotc.ir.sampling import clock, framed, projected
from shotc.ir.trajectory import VerifiedIR
from tests.support.clock_films import SCENE_FILE, some_clock_film
from tests.support.few import few

pytestmark = pytest.mark.slow

Blocks = Literal["scene", "zones"]
NOT_LED = "allow: [fast-pan, hidden-subject]"


@cache
def film(seed: int, blocks: Blocks, folder: Path, allow: str = "allow: [fast-pan]") -> Compilation:
    made = some_clock_film(np.random.default_rng([seed, 7]), blocks)
    (folder / SCENE_FILE).write_bytes(made.scene)
    text = made.text.replace("allow: [fast-pan]", allow)
    return compile_source(text.encode(), "film.yaml", folder, PlanOptions(refiner="none"))


def frames(plan: VerifiedIR) -> tuple[Array, Array]:
    """Return the share of the outline that is hidden in each frame, and whether the frame shows all of it."""
    of, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    t = clock(of.rate, track.curve.end)
    t = t[framed(track, "film", "walker", t)]
    covered = coverage(of, (), "walker", track.curve(t)[:, :3], t).share
    return covered, projected(of, track, "walker", t).in_frame


@pytest.mark.long
@pytest.mark.parametrize("blocks", ["scene", "zones"])
@pytest.mark.parametrize("seed", few([1, 3, 4, 8], [3]))
def test_less_is_hidden_from_a_way_that_is_led_and_keyframes_stay(
    seed: int, blocks: Blocks, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.getbasetemp()
    plain, led = film(seed, blocks, folder, NOT_LED).plan, film(seed, blocks, folder).plan
    assert plain is not None
    assert led is not None
    (before, _), (after, whole) = frames(plain), frames(led)
    assert (before > HALF_SHARE).mean() > 0.05
    assert after.mean() < 0.8 * before.mean()
    assert whole.all()
    assert led.trajectory.deviations, "a way that is led is told"
    mission, (track,) = led.trajectory.keyframes.mission, led.trajectory.drones
    (placed,) = led.trajectory.keyframes.shots
    for keyframe, time in zip(placed.shot.keyframes, track.keyframes, strict=True):
        assert time.time == pytest.approx(20.0 + (keyframe.time or 0.0), abs=1e-6)
        assert track.curve(time.time)[:3] == pytest.approx(place_of(mission, keyframe, time.time), abs=1e-3)


STAND = """\
shotc: 1
mission: stand
world: {zones: {kiosk: {keep: out, box: {center: [40, -6, 2], size: [3, 3, 4]}}}}
targets: {walker: {track: {points: [[0, 0, 0.9], [90, 0, 0.9]], speed: 1.5}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [40, -30]}}
shots:
  - id: film
    drone: cam
    kind: keyframes
    target: walker
    timing: {start: 20, duration: 14}
    keyframes: [KEYFRAMES]
"""
PLACE = "{at: [40, -14, 3], look_at: walker}"


def away_from_first(keyframes: str) -> float:
    """Return how far the camera comes from its first place in the film, metres."""
    text = STAND.replace("KEYFRAMES", keyframes)
    plan = compile_source(text.encode(), "stand.yaml", None, PlanOptions(refiner="none")).plan
    assert plan is not None
    (track,) = plan.trajectory.drones
    places = track.curve(np.linspace(20.0, 34.0, 141))[:, :3]
    assert frames(plan)[0].max() > HALF_SHARE
    return float(np.linalg.norm(places - places[0], axis=1).max())


def test_a_camera_between_two_keyframes_in_one_place_stays_there() -> None:
    assert away_from_first(f"{PLACE}, {PLACE}") < 0.01
