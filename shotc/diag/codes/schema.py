"""S: the shape of a mission: keys, types, lengths, words. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import LOOK, slip

CODES: tuple[CodeInfo, ...] = (
    slip(
        "S001",
        "missing-version",
        "the mission does not say its language version",
        "Every mission says which version of the language it is written in, so that later versions of shotc"
        " can still read it. The rest of the file is checked as version 1 in the same run. Add `shotc: 1` "
        "as the first line.",
        LOOK,
        ("shotc: 1\n", ""),
    ),
    slip(
        "S002",
        "unknown-version",
        "the mission is written in another version of the language",
        "`shotc` names the version of the language, not of the tool; this tool reads version 1. Nothing "
        "else is judged, because another version may mean other things by the same words. Write `shotc: 1`,"
        " or use the tool that the mission was written for.",
        LOOK,
        ("shotc: 1\n", "shotc: 2\n"),
    ),
    slip(
        "S003",
        "unknown-field",
        "a key is not part of the language here",
        "An unknown key is refused, not ignored: otherwise a misspelt limit would be no limit. The nearest "
        "known key is proposed. Some keys belong one level up or down: `hfov` of a drone stands under "
        "`camera`.",
        LOOK,
        ("home: [0, -60, 0]", "hom: [0, -60, 0]"),
    ),
    slip(
        "S004",
        "missing-field",
        "a key that has to be there is missing",
        "The mapping is incomplete. The key of the mapping that lacks it is underlined, or the first line "
        "for keys of the mission itself. Keys that belong together are reported the same way: a heading "
        "needs a pitch beside it.",
        LOOK,
        ("radius: 4, height: 24", "height: 24"),
    ),
    slip(
        "S005",
        "conflicting-fields",
        "two keys say the same thing in different ways",
        "Some things can be written in more than one way, of which a mission picks one: a camera looks at "
        "something, or has heading and pitch; a target stands at a place, or has a track; a zone is a "
        "cylinder, a polygon or a box. Remove one of the two. An aspect beside a sensor with width and height is "
        "allowed as long as both say the same.",
        LOOK,
        ("look_at: tower", "look_at: tower, heading: 10 deg"),
    ),
    slip(
        "S006",
        "empty-value",
        "a key has no value",
        "A key has nothing after its colon, or an explicit null. Either its default is meant, or something "
        "was forgotten. Write the value, or remove the key.",
        LOOK,
        ("wind: 3 m/s", "wind: null"),
    ),
    slip(
        "S007",
        "wrong-type",
        "a value is of the wrong type",
        "The language expects another type here: for example a list instead of a single value, a mapping "
        "instead of text, or a number instead of true or false. In YAML, text in quotes is never a number.",
        LOOK,
        ("home: [0, -60, 0]", "home: under the tree"),
    ),
    slip(
        "S008",
        "wrong-length",
        "a list has the wrong number of items",
        "Positions have three values [x, y, z], of what stands on the ground two; screen points two [u, v], ranges two [lowest, highest]; a "
        "polygon has at least three corners, a path at least two points.",
        LOOK,
        ("home: [0, -60, 0]", "home: [0]"),
    ),
    slip(
        "S009",
        "unknown-value",
        "a word is not one of the allowed values",
        "Drone models, composition sets, screen points, paces and the like are chosen from a list. The "
        "nearest name is proposed. `shotc list` prints what there is.",
        LOOK,
        ("model: x500", "model: x5000"),
    ),
    slip(
        "S010",
        "unknown-kind",
        "the kind of shot does not exist",
        "The kind says how a shot's parameters are read, so they cannot be checked without it; what every "
        "shot has is checked all the same. `shotc list kinds` prints the kinds that are installed; plugins "
        "add more.",
        LOOK,
        ("kind: static", "kind: statik"),
    ),
    slip(
        "S011",
        "unsafe-name",
        "a name cannot be used",
        "Names of missions, shots, drones, targets and zones become file names, table cells and messages of"
        " other tools. They are made of letters, digits, `-`, `_` and `.`, at most 64 characters, and start"
        " with a letter or digit, so that no name leaves the output folder or is taken for an option.",
        LOOK,
        ("mission: look", "mission: ../../look"),
    ),
    slip(
        "S012",
        "unsafe-path",
        "a file path leaves the mission's folder",
        "Files that a mission names stay inside the folder of the mission, so that checking a mission from "
        "elsewhere never reads other files. The path is relative, with `/` between folders, without `..`, "
        "drive letters and backslashes.",
        LOOK,
        ("  wind: 3 m/s", "  terrain: {file: ../../hills.tif}"),
    ),
    slip(
        "S013",
        "inverted-range",
        "a range runs from high to low, or is empty",
        "A range is written [lowest, highest]. A height from 12 to 0 encloses nothing; most often the two "
        "values are swapped.",
        LOOK,
        ("height: [0, 12]", "height: [12, 0]"),
    ),
    slip(
        "S014",
        "out-of-range",
        "a number lies outside its allowed range",
        "Radii, limits and durations are positive, shares lie between 0 and 1, a pitch between -90 and 90 "
        "degrees, a latitude between -90 and 90. The help names the bounds. A value in the wrong unit is a "
        "common cause.",
        LOOK,
        ("radius: 4", "radius: -4"),
    ),
    slip(
        "S015",
        "impossible-camera",
        "no camera has this field of view or aspect",
        "The horizontal field of view of a camera without fisheye distortion lies well below 180 degrees; "
        "shotc plans from 1 to 170. It is given as `hfov`, or by `sensor` and `focal_length`, where a slip "
        "in the units (centimetres for millimetres) is the usual cause. The aspect is frame width over "
        "height, such as 16:9.",
        LOOK,
        ('"16:9"', '"16:0"'),
    ),
    slip(
        "S016",
        "no-shots",
        "the mission films nothing",
        "A mission without shots has nothing to plan. Add a shot under `shots`, or start from a template "
        "with `shotc new`.",
        LOOK,
        (LOOK[LOOK.index("shots:") :], "shots: []\n"),
    ),
    slip(
        "S017",
        "not-a-mission",
        "a plan stands where a mission is wanted",
        "`shotc check` and `shotc plan` read missions, the YAML that people write. The plan.json that `shotc "
        "plan` makes of one is read by `shotc verify`, `emit`, `view` and `diff`. The plan names its mission "
        "file under `source`.",
        LOOK,
        (LOOK, '{"format": "shotc-plan", "version": 1}\n'),
    ),
)
