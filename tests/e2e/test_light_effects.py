"""The mission with effects of lights that the guide shows, planned, read back and played."""

from __future__ import annotations

import re
from base64 import b64decode
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import shotc
from shotc import api
from shotc.geom.fleet_spline import places
from shotc.ir.light_colors import light_colors
from shotc.ir.trajectory import VerifiedIR
from shotc.planfile.read import read_plan
from shotc.planfile.write import plan_bytes
from shotc.show.emit.skyc.light_programs import TOLERANCE_LEVELS, programs
from tests.support import skyc_reader
from tests.support.compiled import compiled

SPECS = Path(__file__).parents[2] / "specs"
GUIDE = (Path(shotc.__file__).parent / "docs" / "language.md").read_text(encoding="utf-8")
MISSION = re.search(r"```yaml\n(shotc: 1\nmission: lantern.*?)```", GUIDE, re.DOTALL)


@cache
def planned() -> VerifiedIR:
    assert MISSION is not None
    done = api.compile_source(MISSION[1].encode(), "lantern.yaml", None, api.PlanOptions())
    assert done.plan is not None, done.diagnostics
    assert not done.diagnostics
    return done.plan


@pytest.mark.slow
def test_the_ramp_of_the_guide_is_as_it_is_read_aloud() -> None:
    (flight,) = planned().trajectory.fleets
    stand = flight.shown[0]
    time = np.array([stand.start - 0.04])  # neither the chase nor the sparkle has begun
    heights = places(flight.breaks, flight.coef, np.array([stand.start]))[:, 0, 2]
    share = (heights - heights.min()) / np.ptp(heights)
    wanted = np.stack(
        [np.interp(share, (0, 0.5, 1), one) for one in ((220, 255, 255), (20, 215, 255), (60, 0, 240))],
        axis=1,
    )
    assert np.abs(light_colors(flight, time)[:, 0] - wanted).max() <= 3.0


@pytest.mark.slow
def test_what_fades_to_black_is_black() -> None:
    (flight,) = planned().trajectory.fleets
    end = flight.shown[1].end
    last = light_colors(flight, np.array([end - 2.1, end - 1.0, end, end + 2.0]))
    level = last.max(axis=(0, 2)).astype(int)
    assert level.tolist() == [235, pytest.approx(117, abs=4), pytest.approx(0, abs=6), 0]


@pytest.mark.long
def test_a_plan_read_back_has_the_same_lights_and_plays_them() -> None:
    plan = planned()
    data = plan_bytes(plan)
    read = read_plan(data, "plan.json")
    assert read.diagnostics == ()
    assert read.trajectory is not None
    assert len(data) < 1_000_000
    again = VerifiedIR(read.trajectory, read.certificate)
    assert plan_bytes(again) == data
    made, same = (
        {a.name: a.data for a in api.emit_plan(p, ("skyc", "csv")).artifacts} for p in (plan, again)
    )
    assert made == same
    show = skyc_reader.read(made["lantern.skyc"])
    (flight,) = plan.trajectory.fleets
    times = np.arange(0.0, flight.breaks[-1], 0.31)
    wanted = light_colors(flight, times)
    for k in range(0, 120, 17):
        code = b64decode(show["swarm"]["drones"][k]["settings"]["lights"]["data"])
        found = np.array([skyc_reader.color_at(code, t) for t in times])
        assert np.abs(found - wanted[k]).max() <= 2.51


def damaged(plan: bytes, old: str, new: str) -> tuple[str, ...]:
    text = plan.decode()
    assert old in text, old
    return tuple(d.message for d in read_plan(text.replace(old, new, 1).encode(), "plan.json").diagnostics)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (r'"blend": "add",\s+"opacity": 1.0', '"blend": "add", "opacity": 7.0', "opacity"),
        (r'"period": 0.8, "seed"', '"period": 0.0, "seed"', "period"),
        (r'"seed": ', '"seed": -', "seed"),
        (r'"at": \[0.0, 0.5, 1.0\], "along"', '"at": [0.0, 1.5, 1.0], "along"', "does not rise"),
        (r'"of": \[-1, 0', '"of": [-1, 9', "look"),
    ],
)
def test_effects_of_a_plan_that_mean_nothing_are_told(old: str, new: str, says: str) -> None:
    text, lights = plan_bytes(planned()).decode().split('"lights": ')
    changed, count = re.subn(old, new, lights, count=1)
    assert count
    (found, *_) = read_plan(f'{text}"lights": {changed}'.encode(), "plan.json").diagnostics
    assert says in found.message


@pytest.mark.fuzz
def test_the_dense_show_of_the_tree_stands_at_its_separation_and_plays() -> None:
    done = compiled(SPECS / "elbe-lights.yaml")
    assert done.plan is not None
    assert done.diagnostics == ()
    (claim,) = (c for c in done.plan.certificate if c.constraint == "separation")
    assert claim.holds
    assert 1.45 <= claim.worst < 1.46
    (flight,) = done.plan.trajectory.fleets
    times = np.arange(0.0, flight.breaks[-1], 0.093)
    wanted = light_colors(flight, times, slice(0, 3))
    for drone, code in zip(wanted, programs(flight), strict=False):
        found = np.array([skyc_reader.color_at(code, t) for t in times])
        assert np.abs(found - drone).max() <= TOLERANCE_LEVELS + 0.51
