"""V031, V050 and on: what an audience is not shown."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

_WALL = """\
shotc: 1
mission: wall
world: {zones: {wall: {keep: out, box: {center: [EAST, -8, 8], size: [20, 2, 16]}}}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: look, kind: static, drone: cam, at: [0, -24, 6], look_at: mast}
"""

SHOWN: tuple[CodeInfo, ...] = (
    CodeInfo(
        "V031",
        "target-hidden",
        Severity.WARNING,
        "something stands before a target for a part of its shot",
        "Another target, a keep-out zone or another drone stands on the line of sight from the camera to the centre of "
        "the target, or the centre is within a keep-out zone. Targets whose cylinders overlap or touch, as a lantern in "
        "its tower, are parts of one thing and do not hide each other. The notes tell what hides it in how many of the "
        "frames, and the middle of the longest stretch. Film from another side or from higher up. The refiner `ours` goes "
        "aside by itself in shots of moving targets, as far as that shows more. Where it is hidden in most frames, that "
        "is an error (V050).",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "V050",
        "hidden-subject",
        Severity.ERROR,
        "a shot shows its subject in fewer than half of its frames",
        "A shot has a subject so that it is seen. Here something stands before it, or round it, in most of the "
        "frames: a keep-out zone, another target or another drone on the line of sight to its centre (V031 tells "
        "of less than half). The notes tell what hides it in how many frames. Film from another side or from higher "
        "up, or move what hides it. Where it is meant, as with a zone that can be looked through, write "
        "`allow: [hidden-subject]` in the shot, or under `rules` for the whole mission; then nothing is told.",
        _WALL.replace("EAST", "0"),
        _WALL.replace("EAST", "40"),
        "plan",
    ),
)
