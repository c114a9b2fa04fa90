"""V028, V029, V031, V050 and up: subjects that are covered, not in the picture or not visible long enough."""

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

_LENS = """\
shotc: 1
mission: portrait
targets: {mast: {at: [0, 0, 6], radius: 1, height: 2}}
drones: {cam: {model: x500, home: [0, -30, 0], camera: {sensor: 36 mm, focal_length: 85 mm, aperture: STOP}}}
shots:
  - {id: look, kind: static, drone: cam, at: [0, -12, 6], look_at: mast, timing: {duration: 6}}
"""

_RUNNER = """\
shotc: 1
mission: passing
targets: {runner: {track: {start: [-30, 0, 0.9], velocity: [3, 0, 0]}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [0, -30, 0], camera: {hfov: 60 deg, shutter: TIME}}}
shots:
  - id: pass
    kind: static
    drone: cam
    target: runner
    at: [0, -20, 3]
    heading: 0 deg
    pitch: -4 deg
    timing: {start: 9, duration: 2}
"""

_REVEAL = """\
shotc: 1
mission: reveal
world: {zones: {wall: {keep: out, box: {center: [EAST, -8, 8], size: [20, 2, 16]}}}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - id: out
    kind: keyframes
    drone: cam
    target: mast
    require: {reveal: {from: 0 %, to: 100 %}}
    keyframes: [{at: [0, -24, 6], look_at: mast}, {at: [-30, 0, 6], look_at: mast}]
"""

SHOWN: tuple[CodeInfo, ...] = (
    CodeInfo(
        "V028",
        "covered-more-than-promised",
        Severity.ERROR,
        "more of a target is covered in a frame than its shot promises",
        "`require: {visible: 90 %}` promises the least share of the target's outline that nothing covers, "
        "in any frame: keep-out zones, terrain, scenes, other targets, other drones. It is sampled: at "
        "every tick of the output rate, by rays to the outline. What the edge of the frame cuts off does "
        "not count; that is `in_frame`. The notes say what covers it, how much and how often. Film from "
        "another side or from higher up, or promise less.",
        _WALL.replace("EAST", "10.3").replace("look_at: mast}", "look_at: mast, require: {visible: 90 %}}"),
        _WALL.replace("EAST", "40").replace("look_at: mast}", "look_at: mast, require: {visible: 90 %}}"),
        "plan",
    ),
    CodeInfo(
        "V029",
        "reveal-broken",
        Severity.ERROR,
        "a shot does not reveal its target as it promises",
        "`require: {reveal: {from: 0 %, to: 100 %}}` promises how much of the target's outline is free in "
        "the first frame and in the last. The smaller share is an upper bound, the larger share a lower "
        "bound. `{from: 100 %, to: 0 %}` loses the target from sight. V031 and V050 are not reported for "
        "such a shot. Begin where something covers the target, and end where nothing does; the notes say "
        "what covers it.",
        _REVEAL.replace("EAST", "60"),
        _REVEAL.replace("EAST", "0"),
        "plan",
    ),
    CodeInfo(
        "V031",
        "target-hidden",
        Severity.WARNING,
        "something stands before a target for a part of its shot",
        "Another target, a keep-out zone, terrain, a scene or another drone covers more than half of the "
        "target's outline in some frame, or the target is within a zone. Targets that overlap or touch, as "
        "a lantern in its tower, are parts of one thing and do not hide each other. The notes tell what "
        "hides how much of it and how often, by the names of buildings and parts of a scene, and when it "
        "is worst. Film from another side or from higher up. Planning leads shots past terrain, scenes and "
        "buildings where the author left the way free, and the refiner `ours` goes aside in shots of "
        "moving targets, as far as that shows more. If it is hidden in most frames, that is an error "
        "(V050). `covered` in framing.csv and the summary show smaller shares; `require: {visible: 90 %}` "
        "makes them an error (V028).",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "V050",
        "hidden-subject",
        Severity.ERROR,
        "a shot shows its subject in fewer than half of its frames",
        "A shot has a subject so that it is seen. Here something covers more than half of its outline in "
        "most of the frames: a keep-out zone, terrain, a scene, another target or another drone (V031 "
        "is for less). The notes name what hides how much of it, and how often. A framing is placed where its "
        "subjects are visible, if it leaves such a place free; else a note says so. Film from another side "
        "or from higher up, or move what hides it. If it is intended, as with a zone that can be looked "
        "through, write `allow: [hidden-subject]` in the shot, or under `rules` for the whole mission.",
        _WALL.replace("EAST", "0"),
        _WALL.replace("EAST", "40"),
        "plan",
    ),
    CodeInfo(
        "V051",
        "pan-flown-too-fast",
        Severity.WARNING,
        "the camera turns faster than a film can show, as it is flown",
        "The rule of F005, held to the plan: over any second of the shot, a frame width goes by in 7 s or "
        "more, or in 3 s or more behind a subject that has its place on screen. `check` knows the mean "
        "rate between keyframes whose time is known; a drone that begins and ends at rest turns faster in "
        "between, and most turns have no time before they are planned. The note has the number that is "
        "flown, and F005 is then not reported. Take more time, turn less, go farther away, or take a wider "
        "lens. If it is intended, write `allow: [fast-pan]` in the shot, or under `rules` for the whole "
        "mission.",
        _PAN.replace("TIMING", "pace: brisk"),
        _PAN.replace("TIMING", "timing: {duration: 20}"),
        "plan",
    ),
    CodeInfo(
        "V061",
        "soft-subject",
        Severity.WARNING,
        "a subject is not sharp from its nearest to its farthest point",
        "With `camera: {aperture: f/2.8}` the depth of field is known. The lens is focused on the centre "
        "of the target that is framed, or on the shot's `focus`, and a thin lens shows points nearer and "
        "farther as discs. Up to `circle_of_confusion` a disc counts as sharp; it is 0.03 mm on a sensor "
        "36 mm wide, and as much less as the sensor is narrower. The notes give the size of the disc and "
        "the range that is sharp. Stop the lens down, film from farther away, or write `allow: "
        "[soft-subject]` in the shot.",
        _LENS.replace("STOP", "f/1.4"),
        _LENS.replace("STOP", "f/4"),
        "plan",
    ),
    CodeInfo(
        "V062",
        "motion-blur",
        Severity.WARNING,
        "a subject moves too far on the picture while the shutter is open",
        "With `camera: {shutter: 1/50 s}` motion blur is known: how far the centre of a target moves on "
        "the picture during one exposure, by the camera's way, its turning, its zoom and the target's own "
        "motion. Up to a 384th of the picture's width, 10 pixels of 3840, there is no warning. What is "
        "behind the subject may be blurred: `background_blur_px` in framing.csv tells how much. Take a "
        "shorter time, fly more slowly, or write `allow: [motion-blur]` in the shot.",
        _RUNNER.replace("TIME", "1/24 s"),
        _RUNNER.replace("TIME", "1/100 s"),
        "plan",
    ),
)
