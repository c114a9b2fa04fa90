"""What a camera stays near while its shot is planned anew: beside a target, where that is taken to be."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.plugin_api.replanner import Plan, Traffic
from shotc.simulation.film import film_of
from shotc.simulation.kalman import STATE_COUNT, Estimate
from shotc.simulation.seen import Foreseen
from shotc.simulation.situations import STAGE_S, ReplanInstant, replanned
from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: near
targets:
  runner: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], times: [0, 60]}, radius: 0.4, height: 1.8}
drones: {cam1: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: s, kind: framing, drone: cam1, timing: {start: 15, duration: 4}, NEAR
     subjects: [{target: runner, frame: center}]}
output: {rate: 5}
"""


@pytest.mark.slow
def test_a_pose_beside_a_target_goes_with_the_estimate_and_a_place_of_the_world_stays() -> None:
    found = []
    for near in (
        "near: {at: {from: runner, offset: [2, -9, 5]}, heading: 10 deg},",
        "near: [20, -9, 5],",
    ):
        done = compiled_text(MISSION.replace("NEAR", near), "none", "m.yaml")
        assert done.plan is not None, done.diagnostics
        ir = done.plan.trajectory
        film = film_of(ir.keyframes.mission, ir.drones[0])
        (shot,) = replanned(ir.keyframes.mission, film.track)
        at = shot.phase.start + 1.0
        stages = at + STAGE_S * np.arange(shot.stages + 1)
        drone = (film.position[film.step(at)], film.velocity[film.step(at)])
        places, moves = (np.tile(each, (len(stages), 1)) for each in drone)
        # The runner is 3 m to the North of his way, and faster.
        mean = np.array([[16.0, 3.0, 0.9, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
        velocity = np.tile(mean[:, 3:6], (len(stages), 1, 1))
        runner = Foreseen(
            Estimate(at, mean, np.eye(STATE_COUNT)[None]),
            mean[:, :3] + (stages - at)[:, None, None] * velocity,
            velocity,
        )
        of = ReplanInstant(
            known={"runner": runner},
            last=Plan(stages, places, moves, np.zeros((shot.stages, 3))),
            run=0,
            turn=0.0,
            rise=0.0,
            traffic=Traffic(np.empty((0, len(stages), 3))),
        )
        found.append(shot.situation(ir.keyframes.mission, film, stages, drone, of).near)
    beside, still = found
    t = STAGE_S * np.arange(len(beside.places))[:, None]
    assert beside.places == pytest.approx(np.array([18.0, -6.0, 5.0]) + t * [2.0, 0.0, 0.0], abs=1e-9)
    assert beside.yaw == pytest.approx(np.radians(80.0))
    assert beside.pitch is None
    assert (still.places == [20.0, -9.0, 5.0]).all()
