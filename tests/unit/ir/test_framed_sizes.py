"""The size of a framing's only subject, where the mission leaves it free and the camera lacks room."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.checking import check_source
from shotc.geom.viewpoint import WHOLE_SIZE, judged
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.framed_scene import lens_of, required_view_at
from tests.support.front_passes import clean

SCALES = (1.0, 30.0)
STANDS_THERE = "rock: {{keep: out, box: {{center: [0, {0}, {1}], size: [{2}, {2}, {0}]}}}}"
FENCE = "field: {{keep: in, box: {{center: [0, {0}, {2}], size: [{1}, {1}, {1}]}}}}"


def mission(scale: float, zone: str, asked: str = "", home: float = 25.0) -> str:
    """Return a framing of a statue of 2 m times ``scale`` from North, where it is 12 m times that away."""
    return f"""\
shotc: 1
mission: no-room
world: {{zones: {{{zone}}}}}
targets: {{statue: {{at: [0, 0, {scale + 5}], radius: {0.3 * scale}, height: {2 * scale}}}}}
drones: {{cam: {{model: x500, camera: {{hfov: 40 deg, aspect: "16:9"}}, home: [0, {home * scale}, 0]}}}}
rules: {{composition: center, target_clearance: 0.2}}
shots:
  - id: a
    kind: framing
    drone: cam
    subjects: [{{target: statue, view: {{azimuth: 0 deg}}{asked}}}]
    timing: {{start: 60, duration: 4}}
"""


def rock(scale: float) -> str:
    return STANDS_THERE.format(12.0 * scale, 6.0 * scale, 6.0 * scale)


def course(text: str) -> StartedFraming:
    lowered = clean(text).mission
    return course_of(lowered, lowered.shots[0], 60.0)


def size_in(text: str) -> float:
    lowered, framing = clean(text).mission, course(text)
    shot = lowered.shots[0]
    needed = required_view_at(lowered, shot.subjects[0], 60.0, 60.0)
    seen = judged(framing.poses[0], lens_of(lowered.drone("cam")), needed)
    assert seen is not None
    return seen.size


@pytest.mark.slow
@pytest.mark.parametrize("scale", SCALES)
def test_a_camera_steps_in_front_of_what_stands_in_its_place(scale: float) -> None:
    """Behind it there is room as well, but the statue would be hidden."""
    framing = course(mission(scale, rock(scale)))
    assert (framing.blocked, framing.hidden) == (0.0, 0.0)
    assert WHOLE_SIZE < size_in(mission(scale, rock(scale))) < 2.0 * WHOLE_SIZE


@pytest.mark.parametrize("scale", SCALES)
def test_a_camera_steps_back_into_the_fence_beyond_its_place(scale: float) -> None:
    text = mission(scale, FENCE.format(45.0 * scale, 60.0 * scale, 30.0 * scale))
    assert course(text).blocked == 0.0
    assert 0.5 * WHOLE_SIZE < size_in(text) < WHOLE_SIZE


@pytest.mark.parametrize("scale", SCALES)
def test_a_camera_steps_forward_inside_a_fence(scale: float) -> None:
    text = mission(scale, FENCE.format(0.0, 20.0 * scale, 10.0 * scale), home=5.0)
    assert course(text).blocked == 0.0
    assert WHOLE_SIZE < size_in(text) < 1.0


@pytest.mark.parametrize("scale", SCALES)
def test_a_size_that_is_asked_for_stays(scale: float) -> None:
    text = mission(scale, rock(scale), f", size: {WHOLE_SIZE}").replace("0 deg}", "0 deg, elevation: 0 deg}")
    assert "M032" in {d.code for d in check_source(text.encode(), "m.yaml", Path()).diagnostics}


@pytest.mark.parametrize("scale", SCALES)
def test_where_there_is_room_the_size_is_the_usual_one(scale: float) -> None:
    text = mission(scale, FENCE.format(0.0, 80.0 * scale, 40.0 * scale))
    assert size_in(text) == pytest.approx(WHOLE_SIZE, abs=1e-3)
