"""Lenses of shots on the mission's clock: sizes between keyframes, whole subjects, range and rate."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import radians

import numpy as np
import pytest
from shotc_casadi.clock.lens import zoomed
from shotc_casadi.clock.refiner import subject_of

from shotc.diag.registry import has_errors
from shotc.ir.path import HFOV, ClockLeg
from tests.support.refiner_scenes import compiled, path_of

pytestmark = pytest.mark.slow

KEYED = """\
shotc: 1
mission: run
targets: {{runner: {{track: {{start: [0, 0, 0.9], velocity: [1.5, 0, 0]}}, radius: 0.4, height: 1.8}}}}
drones: {{cam: {{model: x500, home: [-20, -25, 0], camera: {{{camera}}}}}}}
rules: {{composition: keep}}
shots:
  - id: s
    kind: keyframes
    drone: cam
    target: runner
    timing: {{start: 15, duration: 20}}
    keyframes:
      - {{at: [18, -5, 3], look_at: runner, frame: [0.2, 0], hfov: 70 deg}}
      - {{at: [40, -25, 5], look_at: runner, frame: [0.2, 0], hfov: 29 deg}}
output: {{rate: 20}}
"""
PAST = """\
shotc: 1
mission: past
targets: {{boat: {{track: {{start: [0, 0, 1.5], velocity: [2, 0, 0]}}, radius: 3, height: 3}}}}
drones: {{cam: {{model: x500, home: [-20, -25, 0], camera: {{{camera}}}}}}}
rules: {{composition: center, allow: [fast-pan]}}
shots:
  - {{id: s, kind: flyby, drone: cam, target: boat, behind: 30, ahead: 30, offset: 9, altitude: 4,
     timing: {{start: 20, duration: 18}}, require: {{in_frame: 100 %}}}}
output: {{rate: 20}}
"""
ZOOM = "zoom: [24 mm, 70 mm], hfov: {} deg"


@cache
def planned(text: str, refiner: str = "ours"):
    """A mission, planned without an error."""
    done = compiled(text, refiner)
    assert not has_errors(done.diagnostics), [d.message for d in done.diagnostics]
    return done


def flown(done):
    """Times, poses and the target's distances in the film."""
    (track,) = done.plan.trajectory.drones
    (film,) = (p for p in track.phases if p.shot == "s")
    t = np.linspace(film.start, film.end, 600)
    (target,) = done.plan.trajectory.keyframes.mission.targets
    q = track.curve(t)
    return t, q, np.linalg.norm(q[:, :3] - [target.at(float(u)) for u in t], axis=1)


def claim(done, name):
    """The line of a certificate with a name."""
    (found,) = (c for c in done.plan.certificate if c.constraint == name)
    return found


def test_between_keyframes_of_a_moving_target_its_size_stays_between_theirs():
    plain, zooming = (planned(KEYED.format(camera=ZOOM.format(70)), name) for name in ("none", "ours"))
    low = []
    for done in (plain, zooming):
        _, q, away = flown(done)
        assert np.degrees(q[[0, -1], HFOV]) == pytest.approx([70.0, 29.0], abs=1e-5)
        sizes = 1.0 / (away * np.tan(q[:, HFOV] / 2))
        low.append(sizes.min() / sizes[-1])
    assert low[0] < 0.9
    assert low[1] > 0.98
    rate = claim(zooming, "zoom rate")
    assert rate.holds
    assert 0.5 * rate.limit < rate.worst


def test_the_target_keeps_its_place_on_screen_while_the_lens_zooms():
    done = planned(KEYED.format(camera=ZOOM.format(70)))
    (error,) = (c for c in done.plan.certificate if c.constraint == "runner screen error")
    assert error.worst < 0.05


def test_a_subject_is_kept_whole_by_the_lens_and_the_place_stays():
    fixed, zooming = planned(PAST.format(camera="hfov: 35 deg")), planned(PAST.format(camera=ZOOM.format(35)))
    assert claim(zooming, "boat in frame").worst == 1.0
    assert claim(zooming, "zoom rate").holds
    nearest = [flown(done)[2].min() for done in (fixed, zooming)]
    # With one lens the drone has to go back by a third; the lens lets it pass where it was asked to.
    assert nearest[0] > 12.5
    assert nearest[1] == pytest.approx(np.hypot(9.0, 2.5), abs=0.3)


def test_a_lens_with_nothing_to_win_and_one_that_does_not_zoom_stay():
    path = path_of(planned(KEYED.format(camera=ZOOM.format(70))), "solve-path-qp")
    subject = subject_of(path, "s")
    assert isinstance(subject.leg, ClockLeg)
    assert zoomed(subject, subject.leg) is not None
    assert zoomed(replace(subject, drone=subject.drone._replace(lens=None)), subject.leg) is None
    past = subject_of(path_of(planned(PAST.format(camera=ZOOM.format(35))), "solve-path-qp"), "s")
    assert zoomed(past, past.leg) is not None
    assert zoomed(replace(past, drone=past.drone._replace(autopilot="dji-fly")), past.leg) is None
    same = KEYED.format(camera=ZOOM.format(70)).replace("29 deg", "70 deg")
    still = subject_of(path_of(planned(same), "solve-path-qp"), "s")
    assert zoomed(still, still.leg) is None


def test_a_rate_that_leaves_no_other_way_keeps_the_guides_lens():
    done = planned(KEYED.format(camera="zoom: [24 mm, 70 mm], hfov: 70 deg, zoom_rate: 2.2 deg/s"))
    t, q, _ = flown(done)
    assert np.abs(np.diff(q[:, HFOV]) / np.diff(t)).max() <= radians(2.2) * (1 + 1e-9)
    assert np.degrees(q[[0, -1], HFOV]) == pytest.approx([70.0, 29.0], abs=1e-5)
