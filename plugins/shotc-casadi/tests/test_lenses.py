"""The whole target in every frame, whatever the lens, the picture's shape and the target's size."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
import pytest
from shotc_casadi import frames
from shotc_casadi.camera import Given, camera
from shotc_casadi.conditions import OURS
from shotc_casadi.edges import level_beside
from shotc_casadi.frames import (
    LEAST_HALF_FRAMES,
    between_nodes,
    cropped,
    first_margins,
    insides,
    next_margins,
)
from shotc_casadi.margins import Margins
from shotc_casadi.problem import problem
from shotc_casadi.references import references_at
from shotc_casadi.symbols import PITCH, YAW

from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Piecewise
from shotc.ir.path import CAM_PITCH, CAM_YAW
from tests.support.refiner_scenes import arc, compiled, nodes_of, seen

WHOLE = {"tower": (6.0, 60.0), "person": (0.3, 1.8), "ship": (60.0, 25.0)}


def quarter(hfov, times, of="tower", shape=(16, 9), turns=1):
    """Keyframes a quarter turn apart, at so many times the distance at which the target just fits."""
    radius, height = WHOLE[of]
    wide = tan(radians(hfov) / 2)
    away = times * max(radius + height / 2 / (wide * shape[1] / shape[0]), radius / sin(radians(hfov) / 2))
    z = max(height / 2, 3.0)
    places = [(away * cos(a), away * sin(a)) for a in (k * radians(90) for k in range(turns + 1))]
    rows = "\n".join(f"      - {{at: [{x:.9f}, {y:.9f}, {z}], look_at: it}}" for x, y in places)
    return f"""\
shotc: 1
mission: quarter
targets: {{it: {{at: [0, 0, {z}], radius: {radius}, height: {height}}}}}
drones:
  cam:
    model: x500
    home: [{places[0][0]:.3f}, {places[0][1]:.3f}, 0]
    endurance: 60 min
    camera: {{hfov: {hfov} deg, aspect: "{shape[0]}:{shape[1]}"}}
rules: {{composition: center}}
shots:
  - id: s
    kind: keyframes
    drone: cam
    target: it
    require: {{in_frame: 100 %, screen_error: 0.01}}
    keyframes:
{rows}
output: {{rate: 20}}
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("hfov", "of", "shape"),
    [(20, "tower", (16, 9)), (15, "person", (9, 16)), (39, "ship", (239, 100)), (110, "tower", (1, 1))],
)
def test_a_target_stays_whole_through_any_lens(hfov, of, shape):
    done = compiled(quarter(hfov, 1.15, of, shape))
    assert not has_errors(done.diagnostics), [d.message for d in done.diagnostics]
    assert seen(done.plan, count=300).inside.min() > 0.0


@pytest.mark.long
@pytest.mark.parametrize("turns", [1, 2])
@pytest.mark.parametrize("hfov", [20, 70])
def test_a_promise_is_kept_between_keyframes_at_which_the_target_just_fits(hfov, turns):
    done = compiled(quarter(hfov, 1.0, turns=turns))
    assert not has_errors(done.diagnostics), [d.message for d in done.diagnostics]
    (claim,) = (c for c in done.plan.certificate if c.constraint == "it in frame")
    assert claim.worst == 1.0
    # The keyframes themselves touch the edge, and nothing sticks out of it by more than rounding.
    assert seen(done.plan, count=300).inside.min() == pytest.approx(0.0, abs=1e-7)


def turned(of, by):
    ctrl = of.leg.curve.channels(0, 1, 2, CAM_YAW, CAM_PITCH).ctrl.copy()
    ctrl[:, :, 3] += by
    return Piecewise(of.leg.curve.breaks, ctrl)


def test_how_far_inside_counts_half_frames_from_every_edge():
    of = arc()
    s = nodes_of(of).s
    references, q = references_at(of, OURS, s), turned(of, 0.0)(s)
    left, right, bottom, top = insides(of, references, s, q).T
    # Both edges together are the frame less the target.
    assert (left + right < 2.0).all()
    assert (bottom + top < 2.0).all()
    aside = insides(of, references, s, turned(of, 0.1)(s))
    assert (np.sign(aside[:, 0] - left) == -np.sign(aside[:, 1] - right)).all()


def test_nodes_ask_for_as_much_more_as_was_cropped_beside_them():
    of, nodes = arc(), nodes_of(arc())
    first = first_margins(of, nodes, references_at(of, OURS, nodes.s))
    assert next_margins(of, nodes, first, turned(of, 0.0)).inside == pytest.approx(first.inside)
    out = turned(of, 0.55)
    lack = cropped(of, out)
    assert lack > 0.01
    again = next_margins(of, nodes, first, out)
    more = again.inside - first.inside
    assert more.max() == pytest.approx(
        min(lack + LEAST_HALF_FRAMES, frames.MOST_HALF_FRAMES - first.inside.max()), rel=1e-6
    )
    dense = between_nodes(of, out)
    assert (more[:, dense.inside.min(axis=0) > LEAST_HALF_FRAMES] == 0.0).all()


def touching(of):
    """The same shot of a target that just fits into the frame at each of its keyframes."""
    nodes = nodes_of(of)
    tower = of.mission.targets[0]

    def least(height):
        made = of._replace(
            mission=of.mission._replace(targets=(tower._replace(shape=tower.shape._replace(height=height)),))
        )
        s = nodes.s[nodes.pins]
        return insides(made, references_at(made, OURS, s), s, turned(made, 0.0)(s)).min(), made

    low, high = 1.0, 200.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if least(middle)[0] > 0.0 else (low, middle)
    return least(low)[1], nodes


def test_a_camera_goes_level_through_keyframes_at_which_the_target_touches_the_edge():
    of, nodes = touching(arc())
    task = problem(
        of, OURS, nodes, references_at(of, OURS, nodes.s), np.zeros((len(nodes.s), 0, 4)), Margins()
    )
    states = task.states.copy()
    states[:, :2] *= 1.0 + 0.02 * np.sin(nodes.s / 7.0)[:, None]
    states[nodes.pins] = task.states[nodes.pins]
    given = Given(nodes.s[nodes.pins], states[nodes.pins][:, [YAW, PITCH]])
    plain = camera(of.drone, of.leg, nodes, states, given)
    level = level_beside(of, nodes, plain, given)
    assert len(level.through) > 0
    found = camera(of.drone, of.leg, nodes, states, level)
    assert found.derivative()(level.through) == pytest.approx(level.slopes, abs=1e-9)
    pins = nodes.s[nodes.pins]
    assert found(pins) == pytest.approx(plain(pins), abs=1e-9)
    for k, s in enumerate(pins):
        beside = np.clip(s + np.array([-0.02, 0.02]), pins[0], pins[-1])
        before, after = (
            insides(of, references_at(of, OURS, beside), beside, q(beside)) for q in (plain, found)
        )
        assert after.min() > -1e-6
        assert before.min() < -1e-5 or k in (0, len(pins) - 1)
    assert len(level_beside(of, nodes, found, given).through) == 0


def test_beside_a_keyframe_at_the_edge_nodes_ask_for_what_backing_off_can_give():
    of = arc()
    tower = of.mission.targets[0]
    tall = tower._replace(shape=tower.shape._replace(height=1e3))
    near = of._replace(mission=of.mission._replace(targets=(tall,)))
    nodes = nodes_of(near)
    asked = first_margins(near, nodes, references_at(near, OURS, nodes.s)).inside
    own = insides(near, references_at(near, OURS, nodes.s), nodes.s, turned(near, 0.0)(nodes.s))
    pins = nodes.pins
    assert asked[pins] == pytest.approx(np.minimum(own[pins], frames.INSIDE_HALF_FRAMES))
    assert (np.diff(asked[pins[0] : pins[0] + 3, 2]) > 0).all()
