"""S: the shape of a mission: keys, types, lengths, words. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.model import Severity
from shotc.diag.registry import CodeInfo

_PASSING = """\
shotc: 1
mission: look
world:
  wind: 3 m/s
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], camera: {hfov: 70 deg, aspect: "16:9"}}
rules: {composition: thirds, pace: calm}
shots:
  - {id: wide, kind: static, drone: cam1, target: tower, at: [0, -50, 15], look_at: tower, timing: {duration: 5}}
"""


def _code(number: int, slug: str, summary: str, explanation: str, slip: tuple[str, str]) -> CodeInfo:
    """Return a code whose failing mission is the passing one with a slip of the pen: (right, wrong)."""
    failing = _PASSING.replace(*slip)
    return CodeInfo(f"S{number:03}", slug, Severity.ERROR, summary, explanation, failing, _PASSING)


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "missing-version",
        "the mission does not say its language version",
        "Every mission says which version of the language it is written in, so that later versions of shotc"
        " can still read it. The rest of the file is checked as version 1 in the same run. Add `shotc: 1` "
        "as the first line.",
        ("shotc: 1\n", ""),
    ),
    _code(
        2,
        "unknown-version",
        "the mission is written in another version of the language",
        "`shotc` names the version of the language, not of the tool; this tool reads version 1. Nothing "
        "else is judged, because another version may mean other things by the same words. Write `shotc: 1`,"
        " or use the tool that the mission was written for.",
        ("shotc: 1\n", "shotc: 2\n"),
    ),
    _code(
        3,
        "unknown-field",
        "a key is not part of the language here",
        "A key that is not known is refused instead of ignored: a limit with a slip of the pen would "
        "otherwise be no limit. The nearest known key is proposed. Some keys belong one level up or down: "
        "`hfov` of a drone stands under `camera`.",
        ("home: [0, -60, 0]", "hom: [0, -60, 0]"),
    ),
    _code(
        4,
        "missing-field",
        "a key that has to be there is missing",
        "The mapping is incomplete. What is underlined is the key of the mapping that lacks it, or the "
        "first line for keys of the mission itself. Keys that belong together are reported the same way: a "
        "heading needs a pitch beside it.",
        ("radius: 4, height: 24", "height: 24"),
    ),
    _code(
        5,
        "conflicting-fields",
        "two keys say the same thing in different ways",
        "Some things can be written in more than one way, of which a mission picks one: a camera looks at "
        "something, or has heading and pitch; a target stands at a place, or has a track; a zone is a "
        "cylinder, a polygon or a box. Remove one of the two. An aspect beside a sensor with width and height is "
        "allowed as long as both say the same.",
        ("look_at: tower", "look_at: tower, heading: 10 deg"),
    ),
    _code(
        6,
        "empty-value",
        "a key has no value",
        "A key is written down and nothing after its colon, or an explicit null. Whether its default is "
        "meant or something was forgotten cannot be told. Write the value, or remove the key.",
        ("home: [0, -60, 0]", "home: null"),
    ),
    _code(
        7,
        "wrong-type",
        "a value is of the wrong type",
        "The language expects another shape here: a list where a single value stands, a mapping where there"
        " is text, a number where there is true or false. In YAML, text in quotes is never a number.",
        ("home: [0, -60, 0]", "home: under the tree"),
    ),
    _code(
        8,
        "wrong-length",
        "a list has the wrong number of items",
        "Positions have three values [x, y, z], screen points two [u, v], ranges two [lowest, highest]; a "
        "polygon has at least three corners, a path at least two points.",
        ("home: [0, -60, 0]", "home: [0, -60]"),
    ),
    _code(
        9,
        "unknown-value",
        "a word is none of those that may stand here",
        "Drone models, composition sets, screen points, paces and the like are chosen from a list. The "
        "nearest name is proposed. `shotc list` prints what there is.",
        ("model: x500", "model: x5000"),
    ),
    _code(
        10,
        "unknown-kind",
        "there is no such kind of shot",
        "The kind says how a shot's parameters are read, so they cannot be checked without it; what every "
        "shot has is checked all the same. `shotc list kinds` prints the kinds that are installed; plugins "
        "add more.",
        ("kind: static", "kind: statik"),
    ),
    _code(
        11,
        "unsafe-name",
        "a name cannot be used",
        "Names of missions, shots, drones, targets and zones become file names, table cells and messages of"
        " other tools. They are made of letters, digits, `-`, `_` and `.`, at most 64 characters, and start"
        " with a letter or digit, so that no name leaves the output folder or is taken for an option.",
        ("mission: look", "mission: ../../look"),
    ),
    _code(
        12,
        "unsafe-path",
        "a file path leaves the mission's folder",
        "Files that a mission names stay inside the folder of the mission, so that checking a mission from "
        "elsewhere never reads other files. The path is relative, with `/` between folders, without `..`, "
        "drive letters and backslashes.",
        ("  wind: 3 m/s", "  scene: ../../scene.ply"),
    ),
    _code(
        13,
        "inverted-range",
        "a range runs from high to low, or is empty",
        "A range is written [lowest, highest]. A height from 12 to 0 encloses nothing; most often the two "
        "values are swapped.",
        ("height: [0, 12]", "height: [12, 0]"),
    ),
    _code(
        14,
        "out-of-range",
        "a number lies outside what may stand here",
        "Radii, limits and durations are positive, shares lie between 0 and 1, a pitch between -90 and 90 "
        "degrees, a latitude between -90 and 90. The help names the bounds. A value in the wrong unit is a "
        "common cause.",
        ("radius: 4", "radius: -4"),
    ),
    _code(
        15,
        "impossible-camera",
        "no camera has this field of view or aspect",
        "The horizontal field of view of a camera without fisheye distortion lies well below 180 degrees; "
        "shotc plans from 1 to 170. It is given as `hfov`, or by `sensor` and `focal_length`, where a slip "
        "in the units (centimetres for millimetres) is the usual cause. The aspect is frame width over "
        "height, such as 16:9.",
        ('"16:9"', '"16:0"'),
    ),
    _code(
        16,
        "no-shots",
        "the mission films nothing",
        "A mission without shots has nothing to plan. Add a shot under `shots`, or start from a template "
        "with `shotc new`.",
        (_PASSING[_PASSING.index("shots:") :], "shots: []\n"),
    ),
    _code(
        17,
        "not-a-mission",
        "a plan stands where a mission is wanted",
        "`shotc check` and `shotc plan` read missions, the YAML that people write. The plan.json that `shotc "
        "plan` makes of one is read by `shotc verify`, `emit`, `view` and `diff`. The plan names its mission "
        "file under `source`.",
        (_PASSING, '{"format": "shotc-plan", "version": 1}\n'),
    ),
)
