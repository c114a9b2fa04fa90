"""Any framing that can be had is flown, with its size, place and view, in drawn missions."""

from __future__ import annotations

from math import degrees, pi, radians

import numpy as np
import pytest
from hypothesis import Phase, assume, example, given, settings
from hypothesis import strategies as st

from shotc.geom.viewpoint import judged
from shotc.ir.framed import course_of
from shotc.ir.framed_scene import lens_of, required_view_at
from tests.support.framing_missions import claim, planned, text
from tests.support.front_passes import placed

pytestmark = pytest.mark.slow


@pytest.mark.long
@settings(deadline=None, max_examples=3, phases=(Phase.explicit, Phase.generate))
@given(
    size=st.floats(0.12, 0.45),
    azimuth=st.floats(0, 2 * pi),
    elevation=st.floats(0.15, 1.0),
    uv=st.tuples(st.floats(-0.35, 0.35), st.floats(-0.3, 0.3)),
    direction=st.floats(0, 2 * pi),
    speed=st.floats(0.3, 3.0),
)
# Its subject passes where the drone would wait for it.
@example(size=0.4416, azimuth=0.0, elevation=0.356, uv=(0.15, 0.0), direction=4.8804, speed=2.5)
def test_any_framing_that_can_be_had_is_flown(size, azimuth, elevation, uv, direction, speed) -> None:
    x, y = 300 * np.cos(direction), 300 * np.sin(direction)
    subject = (
        f"target: runner, size: {size:.3f}, frame: [{uv[0]:.3f}, {uv[1]:.3f}], "
        f"view: {{azimuth: {degrees(azimuth):.1f} deg, elevation: {degrees(elevation):.1f} deg}}"
    )
    mission = text(subject).replace(
        "[[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: 3 m/s",
        f"[[0, 0, 0.9], [{x:.1f}, {y:.1f}, 0.9]], speed: {speed:.2f} m/s",
    )
    alone = [line for line in mission.splitlines() if not any(w in line for w in ("rider", "33, 1", "tower"))]
    mission = "\n".join(alone)
    ir, found = placed(mission)
    assume(ir is not None and not found)
    assert ir is not None
    shot, lens = ir.mission.shots[0], lens_of(ir.mission.drones[0])
    for t, pose in zip(*course_of(ir.mission, shot, 15.0)[1:3], strict=True):
        look = judged(pose, lens, required_view_at(ir.mission, shot.subjects[0], 15.0, t))
        assert look is not None
        assert look.size == pytest.approx(size, abs=6e-4)
        assert look.screen < 1e-6
        assert look.angle < radians(0.06)
    plan = planned(mission.replace("start: 15, ", ""))
    assert claim(plan, "runner in frame") == 1.0
    assert claim(plan, "runner screen error") < 0.05
    assert claim(plan, "runner size smallest") == pytest.approx(size, rel=0.05)
    assert claim(plan, "runner size largest") == pytest.approx(size, rel=0.05)
