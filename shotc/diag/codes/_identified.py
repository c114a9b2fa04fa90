"""N: targets in a scene that keyframes refer to. See shotc.diag.codes.names."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: towers
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - id: past
    kind: keyframes
    drone: cam1
    keyframes:
      - {at: [0, -60, 15], heading: 0 deg, pitch: 0 deg, target: tower, box: [-0.1, -0.6, 0.1, 0.4]}
      - {at: [0, -45, 15], heading: 0 deg, pitch: 0 deg, target: tower}
output: {emit: [csv]}
"""

IDENTIFIED: tuple[CodeInfo, ...] = (
    CodeInfo(
        "N016",
        "not-identified",
        Severity.ERROR,
        "a keyframe has a box, but no target",
        "A `box` on the screen of a keyframe shows what its author means. `shotc identify` finds out what "
        "of the mission's scene that is, and writes the mission again with the targets that it found; or "
        "the keyframe names its `target` itself. Until then the mission passes `check`, but is not "
        "planned: the camera would follow nothing.",
        _PASSING.replace("target: tower, box", "box"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "N017",
        "nothing-to-identify",
        Severity.ERROR,
        "no target can be looked for: no keyframe asks for one, or there is no scene",
        "`shotc identify` looks for the targets of keyframes with a `box` and without a target, in the meshes, clouds and "
        "buildings of `world.scene` and `world.buildings`. Draw a box round what is meant, as `box: [u0, v0, u1, v1]`, or "
        "accept a guess for keyframes without a box, by `--guess`. Keyframes that have a target are left as they are.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "N018",
        "no-target-in-box",
        Severity.ERROR,
        "what the box of a keyframe holds cannot be a target",
        "Rays through the box meet nothing but sky, or ground, or too little of the scene; or the camera stands inside of the "
        "cylinder about what was found, as in a courtyard: it could not be flown. Draw the box "
        "round what is meant, or move the camera. Where ground that is part of the scene rises, give it as "
        "`world.terrain`, too: what is within 0.5 m of the ground is no target.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "N019",
        "doubtful-target",
        Severity.WARNING,
        "a box may mean another target than the one that was found",
        "Of what is in the box, weighted towards its middle, less than 60 % belongs to the target that was found. The note "
        "names the next one. Look at the sheet of pictures, draw the box closer round what is meant, and identify again.",
        "",
        "",
        "other",
    ),
)
