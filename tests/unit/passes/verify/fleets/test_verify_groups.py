"""The judge holds groups of a fleet against each other, in plans and in the files of shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from shotc.geom.fleet_spline import places
from tests.experiments.planted import FLEET, cruise, show
from tests.support import show_plans
from tests.support.flight_files import verified
from tests.support.grouped_plans import grouped
from tests.support.verdicts import verdict_on

PARTS = show_plans.show(grouped())
BETWEEN = "separation from swarm/middle"
NAMES = {("swarm-1", "swarm-2"), ("swarm-4", "swarm-3")}


def test_groups_that_stay_apart_are_proved_apart() -> None:
    (apart,) = [c for c in verdict_on(PARTS).certificate if c.constraint == BETWEEN]
    assert (apart.holds, apart.subject, apart.method) == (True, "swarm", "bounded")
    assert apart.worst == pytest.approx(4.0, abs=1e-5)
    assert apart.drones in NAMES


def test_a_meeting_of_two_groups_is_found() -> None:
    middle = PARTS.fleets[1]
    coef = middle.coef.copy()
    coef[0, 9:11, 0] -= 3.5  # drone 2 bends towards drone 1 for two control points between stops
    planted = replace(PARTS, fleets=(PARTS.fleets[0], replace(middle, coef=coef)))
    (apart,) = [c for c in verdict_on(planted).certificate if c.constraint == BETWEEN]
    times = np.linspace(0.0, float(middle.breaks[-1]), 4601)
    one, other = (places(track.breaks, track.coef, times) for track in planted.fleets)
    away = (one[:, None] - other[None]) * [1.0, 1.0, 1.15 / 2.15]
    nearest = np.linalg.norm(away, axis=3).min()
    assert 0.0 < nearest < 1.0
    assert not apart.holds
    assert apart.worst == pytest.approx(nearest, abs=1e-3)
    assert apart.drones == ("swarm-1", "swarm-2")


def test_a_show_file_is_judged_across_groups() -> None:
    # Nearest drones of a square are neighbours, and its diagonals are the groups.
    text = FLEET.format(zones="", limits="{speed: 8, climb: 3, descent: 3, acceleration: 300, jerk: 90000}")
    text = text.replace("separation: 1.5", "separation: 1.5, groups: {ends: [1, 4]}")
    text += "  - {id: b, kind: display, fleet: swarm, group: ends,\n"
    text += "     frames: [{sphere: {center: [0, 40, 30], radius: 8}, hold: 2}]}\n"
    pads = ((0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0))
    flights = [cruise((x, y, 0.0), 12.0, 2.0, 8.0) for x, y in pads]
    report = verified(("all.skyc", show(flights)), text=text)
    (apart,) = [c for c in report.certificate if c.constraint == "separation"]
    assert (report.holds, apart.subject) == (True, "swarm")
    assert apart.worst == pytest.approx(4.0, abs=1e-5)
