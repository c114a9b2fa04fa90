"""V031, V050 and on: what an audience is not shown, or not so that it can see it."""

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

_PAN = """\
shotc: 1
mission: pan
drones: {cam: {model: x500, home: [0, -60, 0]}}
shots:
  - id: sweep
    kind: keyframes
    drone: cam
    TIMING
    keyframes:
      - {at: [0, -50, 15], heading: 320 deg, pitch: 0 deg}
      - {at: [4, -50, 15], heading: 20 deg, pitch: 0 deg}
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
    CodeInfo(
        "V051",
        "pan-flown-too-fast",
        Severity.WARNING,
        "the camera turns faster than a film can show, as it is flown",
        "The rule of F005, held to the plan: over any second of the shot, a frame width goes by in 7 s or more, or in "
        "3 s or more behind a subject that has its place on screen. `check` knows the mean rate between keyframes "
        "whose time is known; a drone that begins and ends at rest turns faster in between, and most turns have no "
        "time before they are planned. The note has the number that is flown, and F005 is not told beside it. Take "
        "more time, turn less, go farther away, or take a wider lens. Where it is meant, write `allow: [fast-pan]` in "
        "the shot, or under `rules` for the whole mission.",
        _PAN.replace("TIMING", "pace: brisk"),
        _PAN.replace("TIMING", "timing: {duration: 20}"),
        "plan",
    ),
)
