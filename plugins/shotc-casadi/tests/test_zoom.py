"""The lens as a part of the problem: what it shows between keyframes, and where it stays as it is."""

from __future__ import annotations

from dataclasses import replace
from math import log, radians, tan

import casadi as ca
import numpy as np
import pytest
from shotc_casadi import conditions
from shotc_casadi.conditions import FRAMING_ONLY, LOOK_AT, OURS
from shotc_casadi.lens import is_free, lens_parameters
from shotc_casadi.references import references_at
from shotc_casadi.rounds import refine_shot
from shotc_casadi.symbols import LENGTH, LENS, LENS_ACCELERATION, LENS_FIELDS, LENS_RATE, size, stage

from shotc.diag.registry import has_errors
from shotc.ir.drone import LensRange
from shotc.ir.path import HFOV
from tests.support.refiner_scenes import arc, compiled, nodes_of, seen

HEAD = """\
shotc: 1
mission: zoom
{world}targets: {{it: {{at: [0, 0, 12], radius: 4, height: 24}}}}
drones: {{cam: {{model: x500, home: [0, {home}, 0], camera: {{{camera}}}}}}}
rules: {{composition: center}}
shots:
  - id: s
    kind: keyframes
    drone: cam
    target: it
    require: {{in_frame: 100 %}}
    keyframes:
"""
ZOOM = "zoom: [24 mm, 70 mm], hfov: 50 deg"
LANE = "world: {zones: {lane: {keep: in, box: {center: [0, -36, 12], size: [150, 4, 10]}}}}\n"


def lane(camera, ends=(50, 50)):
    """Past a tower, along a lane that no camera can leave: half-way the tower is twice as near."""
    head = HEAD.format(world=LANE, home=-36, camera=camera)
    rows = [
        f"{{at: [{x}, -36, 12], look_at: it, hfov: {w} deg}}" for x, w in zip((-60, 60), ends, strict=True)
    ]
    return head + "".join(f"      - {row}\n" for row in rows) + "output: {rate: 20}\n"


def backwards(rate="10 deg/s", timing=""):
    """Away from a tower through a lens that is to be long at the end."""
    camera = f"zoom: [24 mm, 70 mm], hfov: 70 deg, zoom_rate: {rate}"
    head = HEAD.format(world="", home=-90, camera=camera).replace("    require", f"{timing}    require")
    rows = ("[0, -40, 12], look_at: it, hfov: 70 deg", "[-100, -60, 12], look_at: it, hfov: 29 deg")
    return head + "".join(f"      - {{at: {row}}}\n" for row in rows) + "output: {rate: 20}\n"


def flown(done, count=400):
    """Times, fields of view and sizes of a shot that was planned."""
    (track,) = done.plan.trajectory.drones
    (film,) = (p for p in track.phases if p.shot == "s")
    t = np.linspace(film.start, film.end, count)
    q = track.curve(t)
    away = np.linalg.norm(q[:, :3] - [0.0, 0.0, 12.0], axis=1)
    return t, q[:, HFOV], 1.0 / (away * np.tan(q[:, HFOV] / 2))


def claim(done, name):
    """The line of a certificate with a name."""
    (found,) = (c for c in done.plan.certificate if c.constraint == name)
    return found


@pytest.mark.slow
def test_between_two_lenses_the_size_goes_straight_from_one_to_the_other():
    plain, zoomed = compiled(backwards(), "none"), compiled(backwards())
    for done in (plain, zoomed):
        _, lens, _ = flown(done)
        assert np.degrees(lens[[0, -1]]) == pytest.approx([70.0, 29.0], abs=1e-6)
        assert claim(done, "zoom rate").holds
    sizes = [flown(done)[2] for done in (plain, zoomed)]
    least = [s.min() / min(s[0], s[-1]) for s in sizes]
    # A lens that is led evenly lets the tower shrink by a tenth and more, half-way, below both of its ends.
    assert least[0] < 0.9
    assert least[1] > 0.995
    assert sizes[1].max() < 1.005 * max(sizes[1][0], sizes[1][-1])


@pytest.mark.slow
def test_a_slow_lens_is_waited_for_and_its_rate_holds_at_every_instant():
    slow = compiled(backwards(rate="1.5 deg/s"))
    rate = claim(slow, "zoom rate")
    assert rate.holds
    assert rate.limit == pytest.approx(radians(1.5))
    t, lens, _ = flown(slow)
    assert np.abs(np.diff(lens) / np.diff(t)).max() <= radians(1.5) * (1 + 1e-9)
    assert t[-1] - t[0] > 41 / 1.5


@pytest.mark.slow
def test_a_promise_is_kept_by_the_lens_where_the_place_cannot_give_way():
    fixed = compiled(lane("hfov: 50 deg"))
    assert "V019" in {d.code for d in fixed.diagnostics}
    zoomed = compiled(lane(ZOOM))
    assert not has_errors(zoomed.diagnostics), [d.message for d in zoomed.diagnostics]
    assert claim(zoomed, "it in frame").worst == 1.0
    assert seen(zoomed.plan, count=400).inside.min() > 0.0
    _, lens, _ = flown(zoomed)
    assert np.degrees(lens[[0, -1]]) == pytest.approx([50.0, 50.0], abs=1e-6)
    assert np.degrees(lens.max()) > 60.0


def lensed(of, *hfov, longest=20.0, widest=90.0):
    """A shot in memory whose drone zooms, its keyframes with these fields of view (deg) of the author's."""
    drone = of.drone._replace(lens=LensRange(radians(longest), radians(widest), radians(10.0)))
    keys = of.placed.keyframes
    wide = hfov or tuple(np.degrees(k.hfov) for k in keys)
    keys = tuple(
        k._replace(hfov=radians(w), placed=True)
        for k, w in zip(keys, np.resize(wide, len(keys)), strict=True)
    )
    curve = of.leg.curve
    at = np.array([m.s for m in of.leg.marks])
    ctrl = curve.ctrl.copy()
    middles = np.linspace(curve.breaks[:-1], curve.breaks[1:], 6, axis=1)
    ctrl[:, :, HFOV] = np.interp(middles, at, [k.hfov for k in keys])
    leg = replace(of.leg, curve=type(curve)(curve.breaks, ctrl))
    return of._replace(drone=drone, placed=of.placed._replace(keyframes=keys), leg=leg)


def free(of, condition=OURS):
    nodes = nodes_of(of)
    return is_free(of, condition, nodes, references_at(of, condition, nodes.s))


def test_the_lens_is_free_where_it_zooms_and_something_is_to_be_won():
    assert free(lensed(arc(), 60, 50))
    assert free(lensed(arc(), 60, 50), FRAMING_ONLY)
    assert not free(lensed(arc(), 60, 50), LOOK_AT)
    assert not free(lensed(arc()))  # one lens, and the whole tower is in it
    assert not free(arc())
    assert free(lensed(arc(), 22))  # the tower does not fit
    assert not free(lensed(arc(), 22, widest=22.0))  # and no wider lens is there
    of = lensed(arc(), 22)
    assert not free(of._replace(drone=of.drone._replace(autopilot="dji-fly")))  # nothing would zoom it there
    of = lensed(arc(), 60, 50)
    assert free(of._replace(drone=of.drone._replace(autopilot="dji-fly")))  # but this was asked for


def test_a_lens_without_anything_to_win_is_the_one_that_is_given():
    plain, zooming = refine_shot(arc(), OURS, 24), refine_shot(lensed(arc()), OURS, 24)
    assert zooming.problem.zooms is False
    assert zooming.camera.ctrl == pytest.approx(plain.camera.ctrl, abs=1e-12)


def test_what_a_lens_costs_counts_shares_of_the_field_of_view():
    of = lensed(arc(), 60, 40)
    nodes = nodes_of(of)
    table = lens_parameters(of, nodes, 3.0, 1e6, 5.0)
    row = dict(zip(LENS_FIELDS, table[5], strict=True))
    made = stage("none", 0, 0, zooms=True)
    cost = ca.Function("cost", [made.z, made.p], [made.cost])
    z, p = np.zeros(made.z.numel()), np.zeros(size(0, 0, zooms=True))
    z[:3], z[LENS] = (30.0, 40.0, 0.0), radians(50)
    p[-len(LENS_FIELDS) :] = table[5]
    p[sum((3, 1, 1, 2)) : sum((3, 1, 1, 2)) + 2] = (
        1.0  # half of the picture's width and height: its shape alone
    )
    z[18 + LENGTH] = 2.0
    half = log(tan(radians(25)))
    by_hand = row["spread_off"] * (half + log(50.0) - row["spread"]) ** 2
    assert float(cost(z, p)) == pytest.approx(by_hand + row["lens_off"] * (half - row["lens"]) ** 2, rel=1e-6)
    z[18 + LENS_ACCELERATION], z[LENS_RATE] = 0.1, 0.2
    more = 2.0 * row["lens_acceleration"] * 0.1**2 + row["lens_still"] * 0.2**2
    assert float(cost(z, p)) == pytest.approx(
        by_hand + row["lens_off"] * (half - row["lens"]) ** 2 + more, rel=1e-6
    )
    after = np.array(ca.Function("after", [made.z, made.p], [made.following])(z, p)).ravel()
    assert after[LENS] == pytest.approx(radians(50) + 2.0 * 0.2 + 0.5 * 0.1 * 2.0**2)
    assert after[LENS_RATE] == pytest.approx(0.4)


def test_the_papers_conditions_have_the_lens_that_is_given():
    of = lensed(arc(), 60, 40)
    for condition in (conditions.LOOK_AT, conditions.ANG):
        assert refine_shot(of, condition, 24).problem.zooms is False
