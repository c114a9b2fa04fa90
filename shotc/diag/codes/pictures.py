"""D050 and up: faults in pictures of fleets that planning finds. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: show
world:
  zones:
    mast: {keep: out, cylinder: {center: [40, 40], radius: 3, height: [0, 60]}}
fleets:
  swarm: {count: 60, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 1, rise: 10}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    viewpoint: [0, -100, 2]
    frames:
      - {sphere: {center: [0, 0, 40], radius: 15}, hold: 4}
      - {text: {text: GO, center: [0, 0, 40], height: 20}, hold: 4}
"""

CODES: tuple[CodeInfo, ...] = (
    CodeInfo(
        "D050",
        "bad-model",
        Severity.ERROR,
        "a mesh or point cloud cannot be drawn",
        "The file is in no format that is read (PLY, OBJ, STL), is cut short, holds nothing, or has points that are no "
        "finite numbers or all in one place. Materials and textures that it names are never opened. Export it anew; "
        "binary PLY keeps the colours of its corners.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D051",
        "open-mesh",
        Severity.ERROR,
        "a mesh that is to be filled is not closed",
        "`fill: volume` puts drones into the inside of a mesh, and a mesh has one where every edge joins an even number "
        "of faces. This one has edges with a face on one side only: a hole, or a sheet. Close it in the program that "
        "made it, or write `fill: surface`, which needs no inside.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D052",
        "model-out-of-scale",
        Severity.ERROR,
        "a model is more than a kilometre large",
        "In the unit that the mission states for it, or that GLB files have, this model is more than 1000 m large, as what "
        "is drawn in millimetres and read as metres is. State the right `units`; or `height`, which scales it: the first "
        "frame becomes that tall, and all others are scaled alike.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D053",
        "uneven-frames",
        Severity.ERROR,
        "one frame of an animation is many times as large as the next",
        "All frames are scaled as the first one is. Here the bounding boxes of two frames in a row differ by more than "
        "a factor of 5, as where one of them was exported in another unit. Export all of them alike.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D054",
        "bad-drawing",
        Severity.ERROR,
        "an SVG file cannot be drawn",
        "Only what is in the file is drawn: paths, rectangles, circles, ellipses, lines and polygons, filled or not. A "
        "file with scripts, with images, with a document type, or that refers to anything outside of it is refused, and "
        "nothing is ever fetched. Texts depend on fonts: turn them into paths. Export it as plain SVG.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D055",
        "unknown-font",
        Severity.ERROR,
        "a text cannot be written in its font",
        "`font` is a .ttf or .otf file beside the mission, or the name of a font of this machine; without it DejaVu "
        "Sans is used, which is always there. Here there is no such font, its file cannot be read, or it lacks some of "
        "the letters. A font file makes the mission the same on every machine.",
        _PASSING.replace("text: GO,", "text: GO, font: No Such Font,"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "D056",
        "more-drones-than-fit",
        Severity.ERROR,
        "more drones than fit into a picture",
        "Goals stand at least as far apart as the separation asks for, sqrt(2) times as far in animations and where a "
        "transition is to be straight. Here more than 95 % of the fleet find no place in the shape and would stay dark. "
        "The numbers of the help are how many drones would fit, how large the picture would have to be, and at which "
        "separation all of them would fit.",
        _PASSING.replace("height: 20}", "height: 0.2}, fill: outline"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "D057",
        "too-few-drones",
        Severity.WARNING,
        "fewer drones than a picture needs to be seen",
        "Letters are read where at least five lights stand in the height of a capital, and along an outline where they "
        "are near enough to show both sides of a stroke: at most one and a half strokes' width apart. The note says how "
        "long the strokes are, and how far apart the lights would be. Anything else takes eight drones, the corners of "
        "a box.",
        _PASSING.replace("text: GO,", "text: GOODBYE,"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "D058",
        "picture-in-the-way",
        Severity.ERROR,
        "drones of a picture would be in a zone, a target or too low",
        "The goals of a picture keep out of keep-out zones and of targets, inside keep-in zones, and above the ground "
        "clearance, with the body of a drone all round. Some of them do not. The help gives the shortest shift of the "
        "whole picture, east, north and up, that gives all of them room.",
        _PASSING.replace("text: GO, center: [0, 0, 40]", "text: GO, center: [40, 40, 40]"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "D059",
        "viewpoint-in-model",
        Severity.ERROR,
        "the viewpoint is inside of what is drawn",
        "Goals are spread for the view from `viewpoint`, along the line of sight to the middle of the picture. From "
        "within the shape there is no such line. Put it where the audience stands, or leave it out: then the drones "
        "show the shape alike from all sides.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D060",
        "nothing-to-fill",
        Severity.ERROR,
        "a picture has nothing of what its fill asks for",
        "`fill: volume` is the inside, `surface` the outer faces, `outline` the edges of a flat picture. This picture "
        "has none of these: balls and meshes have no edges that are meant, and a closed mesh that is flat has no "
        "inside. Take another `fill`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D061",
        "thin-cloud",
        Severity.ERROR,
        "a point cloud has fewer points than the fleet has drones",
        "A point cloud is taken as it is: its points say where drones may stand, and drones stand in the middle of those "
        "that are nearest to them. It takes at least as many points as drones, better thirty times as many. Give a "
        "denser cloud, or a mesh, from which as many points are drawn as are needed.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "D062",
        "dark-drones",
        Severity.WARNING,
        "a picture has no room for all drones, and some stay dark",
        "The lights of a text or a drawing stand on its strokes, or in its fills: one beside them would be read as part "
        "of it. Where a picture holds fewer drones than the fleet has, as near to each other as their separation "
        "allows, the others stand behind it with their lights off (D056 refuses it where more than 95 % would). The "
        "numbers of the help are reckoned from how many it holds, and one picture of that size has been laid out.",
        _PASSING.replace("height: 20}", "height: 5}, fill: outline"),
        _PASSING,
        "plan",
    ),
    CodeInfo(
        "D063",
        "small-letters",
        Severity.WARNING,
        "letters too small for the distance of the lights",
        "The smallest letters that are read have five lights in their height, and lights stand as far apart as the "
        "separation asks for, one above the other usually farther than side by side. In smaller "
        "letters the lights of one stroke are as near to those of the next as to each other. Small letters are taken to "
        "be seven tenths of a capital.",
        _PASSING.replace("text: GO,", "text: G,")
        .replace("height: 20}", "height: 3.6}")
        .replace("count: 60", "count: 12"),
        _PASSING,
        "plan",
    ),
)
