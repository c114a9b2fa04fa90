"""G026 and up: scenes and buildings, and places too near to them. N011 and up: the files of a plan."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import LOOK, slip
from shotc.diag.model import Severity


def _of_a_file(code: str, slug: str, severity: Severity, summary: str, explanation: str) -> CodeInfo:
    """Return a code that a mission shows only together with the file that it names."""
    return CodeInfo(code, slug, severity, summary, explanation, "", "", "other")


_ERROR, _WARNING = Severity.ERROR, Severity.WARNING

OBSTACLES: tuple[CodeInfo, ...] = (
    CodeInfo(
        "G026",
        "unknown-units",
        _ERROR,
        "a scene's file does not say in which unit it is",
        "The coordinates of PLY, OBJ, STL, XYZ, LAS and LAZ files are numbers without a unit, and a house in millimetres "
        "is a thousand times as large. Write the unit of the program that made the file: `units: m` beside `file`. A "
        "GLB file is in metres.",
        LOOK.replace("  wind: 3 m/s\n", "  wind: 3 m/s\n  scene: {file: church.stl}\n"),
        LOOK,
        "other",
    ),
    _of_a_file(
        "G027",
        "home-beside-obstacle",
        _ERROR,
        "a drone cannot take off from its home without touching the scene or a building",
        "Take-off and landing are vertical at home, and the drone's body is a ball of its `radius`, whose middle is the "
        "home. Nothing of `world.scene` and `world.buildings` may come into it on the way, up to the height from which "
        "clearances hold. A home on a roof, or on the ground of a scanned scene, lies the radius above it. Move the home.",
    ),
    _of_a_file(
        "G028",
        "camera-beside-obstacle",
        _ERROR,
        "a camera stands in the scene or a building, or too near to it",
        "What a mission places binds: the plan brings the camera there. `rules.obstacle_clearance` is kept between a "
        "drone's body and every triangle of `world.scene` and `world.buildings`; half the spacing of a cloud's points "
        "is added. The note has the distance and what is near. Move the place, or lower the rule.",
    ),
    _of_a_file(
        "G029",
        "path-beside-obstacle",
        _WARNING,
        "the ideal path of a shot leads through the scene or a building, or too near to it",
        "The path that a kind generates is an ideal: a plan leaves it where something stands in the way, and says by "
        "how much. Give the shot another distance or altitude to keep it.",
    ),
    _of_a_file(
        "G030",
        "large-scene",
        _WARNING,
        "a scene is so large that its unit is probably wrong",
        "A scene of several kilometres is most often a house in millimetres. The help has the unit with "
        "which it has the usual size of a scene. If the size is right, ignore this warning.",
    ),
    _of_a_file(
        "G031",
        "misplaced-scene",
        _ERROR,
        "a scene is smaller than a drone, or lies where no drone of the mission flies",
        "A scene is larger than half a metre, and nothing is flown ten kilometres from the origin. Either "
        "the unit is wrong, or the coordinates count from somewhere else, as those of surveys do: then "
        "`at` says where it stands in the mission. A file of 32-bit numbers is exported anew for that "
        "(G033).",
    ),
    _of_a_file(
        "G032",
        "scene-under-ground",
        _WARNING,
        "much of a scene lies under the ground",
        "No camera sees that part. Most often another axis of the file points up: OBJ and GLB files are "
        "read with y up, STL, PLY and clouds with z up, unless `up` says it. Or its origin is not on the "
        "ground: raise it by `at`. It is only a warning, because foundations, cellars and the ground of a "
        "scan lie under the ground, too. The plan is proved with the scene as it is written; the "
        "storyboard shows whether that is right. A scene that is under the ground as a whole is an error "
        "(G051).",
    ),
    _of_a_file(
        "G033",
        "rounded-coordinates",
        _ERROR,
        "a scene's file holds 32-bit numbers, and its coordinates are so large that they are rounded",
        "STL, GLB and most PLY files hold 32-bit numbers of seven digits: at 5,000 km, where coordinates of surveys lie, "
        "these are half a metre apart, and what is proved would be of another scene. Export the scene with an offset, "
        "and write as `at` where that offset is in the mission; or as OBJ, which is text, or as PLY of doubles. A scene in millimetres has "
        "coordinates as large: the help has the unit.",
    ),
    _of_a_file(
        "G034",
        "bad-footprint",
        _ERROR,
        "a building's outline crosses itself or encloses nothing, or its top is not above its bottom",
        "A footprint is a ring of three or more corners whose sides meet nowhere else. `min_height` is below `height`. "
        "The notes name the buildings. Correct them in the file; most editors of maps have a check for it.",
    ),
    _of_a_file(
        "G035",
        "building-without-height",
        _ERROR,
        "the file of the buildings does not say how high some of them are",
        "A drone may fly over a low building, so a height is never guessed. A building has `height` (`12`, "
        "`12 m`, `40'`) or `building:levels` of 3 m; a part without one has that of its building. Or write "
        "one for all that have none: `buildings: {file: ..., height: 10}`. Take the highest.",
    ),
    _of_a_file(
        "G036",
        "assumed-height",
        _WARNING,
        "some buildings get their height from the mission, because their file has none",
        "`height` under `world.buildings` is that of every building without a height and levels. Drones do "
        "not keep clear of the part of a building that is higher than that. The notes name the first ones.",
    ),
    _of_a_file(
        "G037",
        "left-out",
        _WARNING,
        "part of the file of the buildings does not become an obstacle",
        "Points, lines, polygons that are no buildings beside some that are, and buildings that are out of "
        "reach are left out: drones do not keep clear of them. An outline that its parts do not cover is "
        "reported as well.",
    ),
    _of_a_file(
        "G048",
        "unknown-building",
        _ERROR,
        "a target is an unknown building",
        "`building` is the `name` of a building in the file of `world.buildings`, or its id (`id`, `@id`), "
        "as written there, or the name of a part of `world.scene`. A part of a building has its own. What "
        "was left out of the file (G037) is no building. A building beyond the terrain has no ground.",
    ),
    _of_a_file(
        "G049",
        "two-buildings-of-one-name",
        _ERROR,
        "a target is a building whose name is not unique",
        "The notes give the other names of each, and their places. Write the id of the right one, or "
        "several targets, and a group of them: `parts: [barn-1, barn-2]`. If a part of a building has the "
        "name of the whole, the whole is taken.",
    ),
    slip(
        "G050",
        "no-file-of-buildings",
        "a target is a building, and the mission has no buildings",
        "`building` names one of `world.buildings: {file: ...}` or a part of `world.scene`. Without such a file a target "
        "is written with its place and its size.",
        LOOK,
        ("tower: {at: [0, 0, 12], radius: 4, height: 24}", "tower: {building: St. Mary}"),
    ),
    _of_a_file(
        "G051",
        "scene-below-ground",
        _ERROR,
        "the whole of a scene lies below the ground",
        "Nothing of it is seen, and no drone comes near it. Most often the axis that points up is turned round, so that the "
        "scene hangs down from its floor; or its origin is high up in it. Turn it in the program that made it, say which axis "
        "points `up`, or raise it by `at`.",
    ),
    _of_a_file(
        "G052",
        "heights-disagree",
        _ERROR,
        "terrain and the origin of the mission do not agree on how high the place lies",
        "`world.origin.alt` is the height of the ground above the sea, and most elevation models count from there. Geoid and "
        "ellipsoid differ by 100 m at most. The note says whether one of the two numbers is in feet. Terrain is always in "
        "metres, unless a GeoTIFF says otherwise; `alt` takes a unit: `alt: 1640 ft`.",
    ),
)

FILES: tuple[CodeInfo, ...] = (
    _of_a_file(
        "N011",
        "linked-file-missing",
        _ERROR,
        "a plan was made with a file that is not there",
        "A plan holds the mission and its tables, but of scenes, buildings and large elevation models only the path and "
        "the SHA-256. Without the file nothing can be proved beside it. It is looked for in the folder of the mission, "
        "as the plan names it, and beside the plan. Put it there.",
    ),
    _of_a_file(
        "N012",
        "linked-file-changed",
        _ERROR,
        "a file that a plan was made with has changed",
        "A plan is proved for the scene, the buildings and the ground that it was made with. Bring back that file, or "
        "plan the mission again with this one.",
    ),
    _of_a_file(
        "N013",
        "not-judged",
        _WARNING,
        "a file of the world cannot be judged by this installation",
        "The base install checks missions without numpy. Terrain, scenes and buildings take the extra `plan`: without "
        "it `check` says what it does not judge, and `plan` does not run.",
    ),
)
