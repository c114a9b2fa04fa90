"""Several drones: apart from each other, out of each other's pictures, and each shot of one of them."""

from __future__ import annotations

from itertools import combinations, permutations
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from tests.e2e.conftest import MISSIONS, Plan, Planned
from tests.support.csv_tables import Table
from tests.support.solid_distances import apart, body
from tests.support.written_missions import number, read

pytestmark = pytest.mark.slow

ROUNDING = 1e-5
"""What nine digits of some hundred metres leave."""
SEPARATION = 3.0
"""Metres, where a mission says nothing."""

SEVERAL = [
    pytest.param(path, id=path.stem, marks=pytest.mark.xdist_group(path.stem))
    for path in MISSIONS
    if len(read(path)["drones"]) > 1
]
each_of_several = pytest.mark.parametrize("path", SEVERAL)


def test_there_is_such_a_mission() -> None:
    assert SEVERAL


@each_of_several
def test_every_pair_is_apart_all_the_time(plan: Plan, path: Path) -> None:
    planned = plan(path)
    least = number(planned.written.get("rules", {}).get("separation", SEPARATION))
    assert set(planned.flights) == set(planned.written["drones"])
    for one, other in combinations(planned.flights, 2):
        assert apart(planned.flights, one, other).min() >= least - ROUNDING, (one, other)


@each_of_several
def test_all_begin_and_end_on_their_own_pads(plan: Plan, path: Path) -> None:
    """What counts for separation before and after a flight: a drone stands at its home."""
    planned = plan(path)
    for name, flight in planned.flights.items():
        home = [number(c) for c in planned.written["drones"][name]["home"]]
        assert flight["t_s"][0] == 0
        ends = body(flight, np.array([0.0, flight["t_s"][-1], flight["t_s"][-1] + 60]))
        assert ends == pytest.approx(np.tile(home, (3, 1)), abs=1e-6)


@each_of_several
def test_every_shot_is_of_one_drone(plan: Plan, path: Path) -> None:
    planned = plan(path)
    filmed = {
        (str(s), str(d)) for s, d in zip(planned.motion["shot"], planned.motion["drone"], strict=True) if s
    }
    shots = {shot["id"]: shot["drone"] for shot in planned.written["shots"]}
    assert sorted(shot for shot, _ in filmed) == sorted(shots)
    for shot, drone in filmed:
        assert shots[shot] in ("auto", drone)
        assert set(planned.framing.where(shot=shot)["drone"]) == {drone}
        # and in one go
        rows = np.flatnonzero(planned.flights[drone]["shot"] == shot)
        assert (np.diff(rows) == 1).all()


@each_of_several
def test_nobody_is_in_anybodys_picture(plan: Plan, path: Path) -> None:
    """By the body's centre, at every frame that is filmed, where the mission requires it."""
    planned = plan(path)
    asked = planned.written.get("rules", {}).get("mutual_visibility")
    if asked is None or asked.get("strength", "require") != "require":
        pytest.skip("the mission does not require it")
    seen = {}
    for filming, other in permutations(planned.flights, 2):
        rows = planned.flights[filming].where(phase="shot")
        within = in_picture(planned, filming, rows, body(planned.flights[other], rows["t_s"]))
        if within.any():
            t = rows["t_s"][within]
            seen[filming, other] = f"{within.mean():.1%} of its frames, {t[0]:.2f} s to {t[-1]:.2f} s"
    assert seen == {}


def in_picture(planned: Planned, filming: str, rows: Table, places: Array) -> Array:
    """Tell at which rows a point is within the frame, or within the cone that is to be kept free."""
    yaw, pitch = rows["cam_yaw_rad"], rows["cam_pitch_rad"]
    x, y, z = (places - rows.numbers("x_m", "y_m", "z_m")).T
    # Turned by the yaw, then by the pitch: ahead, to the left and up, as the camera has it.
    level, left = np.cos(yaw) * x + np.sin(yaw) * y, -np.sin(yaw) * x + np.cos(yaw) * y
    ahead, up = np.cos(pitch) * level + np.sin(pitch) * z, -np.sin(pitch) * level + np.cos(pitch) * z
    half_angle = planned.written["rules"]["mutual_visibility"].get("half_angle")
    if half_angle is not None:
        return np.asarray(np.arctan2(np.hypot(left, up), ahead) < number(half_angle, angle=True))
    wide = ahead * np.tan(rows["hfov_rad"] / 2)
    high = wide / planned.mission.drone(filming).aspect
    return np.asarray((ahead > 0) & (np.abs(left) < wide) & (np.abs(up) < high))
