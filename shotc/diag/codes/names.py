"""N: names, and the files that a mission names. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._grouped import UNKNOWN
from shotc.diag.codes._obstacles import FILES
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: towers
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 4, origin: [100, 0, 0]}}}
shots:
  - {id: wide, kind: static, drone: cam1, at: [0, -50, 15], look_at: tower}
  - {id: side, kind: static, drone: cam1, at: [50, 0, 15], look_at: tower, timing: {after: wide}}
  - {id: show, kind: display, fleet: swarm, frames: [{sphere: {center: [100, 0, 40], radius: 20}}]}
output: {emit: [csv]}
"""

_BY_FILE = """\
shotc: 1
mission: towers
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - {id: route, kind: follow-path, drone: cam1, points: [[0, -50, 15], [40, -50, 15]]}
"""

_BOXED = """\
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
        _BOXED.replace("target: tower, box", "box"),
        _BOXED,
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

CODES: tuple[CodeInfo, ...] = (
    slip(
        "N001",
        "unknown-target",
        "a target is named that the mission does not define",
        "A shot's `target`, a `look_at` by name and the subjects of a framing refer to the keys under "
        "`targets`. The nearest known name is proposed. Correct the name, or define the target.",
        _PASSING,
        ("look_at: tower}", "look_at: towr}"),
    ),
    slip(
        "N002",
        "unknown-drone",
        "a drone is named that the mission does not define",
        "A shot's `drone` refers to a key under `drones`, or is `auto`. What the shot asks of its drone is "
        "not judged until the drone is known. Correct the name, or define the drone.",
        _PASSING,
        ("id: wide, kind: static, drone: cam1", "id: wide, kind: static, drone: cam"),
    ),
    slip(
        "N003",
        "unknown-fleet",
        "a fleet is named that the mission does not define",
        "A display's `fleet` refers to a key under `fleets`. Correct the name, or define the fleet.",
        _PASSING,
        ("fleet: swarm", "fleet: swam"),
    ),
    slip(
        "N004",
        "unknown-shot",
        "a shot waits for one that does not exist",
        "`after` in a shot's timing names the id of another shot that has to end first. Correct the name, or "
        "drop `after`: the shots of one drone run in the order in which they are written anyway.",
        _PASSING,
        ("after: wide", "after: wider"),
    ),
    slip(
        "N005",
        "unknown-emitter",
        "an output is asked for that no installed emitter makes",
        "`output.emit` names emitters; `shotc list emitters` shows those that are installed, with those of "
        "plugins. Correct the name, or install the plugin that brings it.",
        _PASSING,
        ("emit: [csv]", "emit: [cvs]"),
    ),
    slip(
        "N006",
        "duplicate-shot",
        "two shots have the same id",
        "Outputs, waits and messages speak of shots by their ids, so each id may be used once. The second "
        "shot of a name is reported. Give it another id.",
        _PASSING,
        ("id: side", "id: wide"),
    ),
    slip(
        "N007",
        "circular-wait",
        "shots wait for each other in a circle",
        "Each shot of the circle waits, by `after`, for one that comes after itself, so that none can ever "
        "begin. Drop one of the waits, or let one of the shots wait for another shot.",
        _PASSING,
        ("look_at: tower}", "look_at: tower, timing: {after: side}}"),
    ),
    slip(
        "N008",
        "missing-file",
        "a file that the mission names cannot be read",
        "Tracks and routes may stand in files of their own. Their paths count from the folder of the "
        "mission, with `/` between folders. Files of the same sort that lie there are proposed. Correct the "
        "path, or put the file there.",
        _BY_FILE,
        ("points: [[0, -50, 15], [40, -50, 15]]", "file: no-such-route.csv"),
    ),
    CodeInfo(
        "N009",
        "unusable-file",
        Severity.ERROR,
        "a file that the mission names does not hold what it should",
        "A track is a CSV file with the columns t,x,y,z or t,lat,lon,height and maybe heading (rad) or "
        "heading_deg, its times rising, or a GPX file with elevations and times; a route is a CSV file "
        "with x,y,z or lat,lon,height, or a GPX file with elevations. All numbers are finite. XML with a "
        "document type declaration is refused, and so is a file of more than 4 MB (terrain, scenes and "
        "buildings: 400 MB). The note names the line of the file. Correct that line.",
        _BY_FILE.replace("points: [[0, -50, 15], [40, -50, 15]]", "file: route.csv"),
        _BY_FILE,
        phase="other",
    ),
    CodeInfo(
        "N010",
        "file-outside",
        Severity.ERROR,
        "a file that the mission names lies outside its folder",
        "A mission may come from anywhere, so it reads only files in its own folder. A link that leads out "
        "of the folder is not followed. Put the file itself into the folder.",
        _BY_FILE.replace("points: [[0, -50, 15], [40, -50, 15]]", "file: link-to-elsewhere.csv"),
        _BY_FILE,
        phase="other",
    ),
    *FILES,
    *IDENTIFIED,
    *UNKNOWN,
)
