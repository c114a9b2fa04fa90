"""Random missions in the manner of the framing paper's: every one is refined, proved and framed."""

from __future__ import annotations

from math import atan, cos, degrees, pi, radians, sin, tan

import numpy as np
import pytest

from shotc.diag.registry import has_errors
from shotc.geom.camera import aim_at
from tests.support.few import few
from tests.support.refiner_scenes import compiled, path_of, seen

pytestmark = pytest.mark.slow

ASPECT, HFOV = 16 / 9, radians(70)


def mission(seed: int) -> str:
    """A cylinder, and sloppy keyframes round it at 1.3 to 2.4 times the distance at which it fits."""
    draw = np.random.default_rng(seed)
    radius, height = draw.uniform(4, 15), draw.uniform(10, 60)
    vfov = 2 * atan(tan(HFOV / 2) / ASPECT)
    fits = max(height / 2 / tan(vfov / 2) + radius, radius / sin(HFOV / 2))
    azimuth = draw.uniform(0, 2 * pi)
    rows = []
    for _ in range(draw.integers(3, 6)):
        azimuth += radians(draw.uniform(25, 70))
        away = fits * draw.uniform(1.3, 2.4)
        at = (
            away * cos(azimuth),
            away * sin(azimuth),
            max(6.0, height / 2 + draw.uniform(-0.2, 0.6) * height),
        )
        third = (0.0, 0.0) if draw.random() < 0.4 else tuple(draw.choice([-1, 1], 2) / 3)
        yaw, pitch = aim_at(
            (-at[0], -at[1], height / 2 - at[2]), tuple(third + draw.normal(0, 0.15, 2)), HFOV, ASPECT
        )
        rows.append(
            f"      - {{at: [{at[0]:.3f}, {at[1]:.3f}, {at[2]:.3f}], "
            f"heading: {degrees(pi / 2 - yaw) % 360:.3f} deg, pitch: {degrees(pitch):.3f} deg}}"
        )
    return "\n".join(
        [
            "shotc: 1",
            f"mission: sweep-{seed}",
            f"targets: {{t: {{at: [0, 0, {height / 2:.3f}], radius: {radius:.3f}, height: {height:.3f}}}}}",
            "drones: {cam: {model: x500, home: [-200, -200, 0]}}",
            "rules: {composition: thirds}",
            "shots:",
            "  - id: s\n    kind: keyframes\n    drone: cam\n    target: t\n    keyframes:",
            *rows,
            "",
        ]
    )


@pytest.mark.parametrize("seed", few(range(8), range(4)))
def test_a_random_mission_is_refined_proved_and_framed(seed):
    done = compiled(mission(seed))
    assert not has_errors(done.diagnostics), [d.message for d in done.diagnostics]
    assert done.plan is not None
    assert not [d.message for d in done.diagnostics if d.code[0] in "PR"]
    stats = dict(path_of(done).stats)
    assert (stats["s.refine_solver"], stats["s.refine_status"]) == ("fatrop", "solved")
    assert stats["s.refine_rounds"] <= 4
    found = seen(done.plan, "s", 150)
    assert found.inside.min() > -1e-3
    assert found.off.mean() < 5e-3
