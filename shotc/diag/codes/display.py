"""D: displays and the fleets that draw them. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes import flights, lights, pictures
from shotc.diag.codes._filmed_shows import FIRED, NAMED
from shotc.diag.codes._grouped import GROUPED, OWN_PADS
from shotc.diag.codes._musical import MUSICAL
from shotc.diag.codes._recorded import RECORDED
from shotc.diag.codes._slips import slip
from shotc.diag.codes._waves import STANDING, WAVES
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: show
world:
  zones:
    sky: {keep: in, polygon: {points: [[-80, -80], [80, -80], [80, 80], [-80, 80]], height: [0, 90]}}
    mast: {keep: out, cylinder: {center: [40, 40], radius: 3, height: [0, 60]}}
fleets:
  swarm: {count: 60, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 2, rise: 10}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    viewpoint: [0, -100, 2]
    timing: {start: 40}
    frames:
      - {sphere: {center: [0, 0, 30], radius: 15}, hold: 4, color: orange}
      - {cube: {center: [0, 0, 65], size: 24}, transition: 12, hold: 4, fill: surface}
      - {text: {text: SHOTC, center: [0, 0, 40], height: 16}, hold: 4, fill: outline}
"""

_MARGIN = _PASSING.replace("separation: 2", "separation: {horizontal: 2, margin: 0.2}")

_HIGH = (
    _PASSING.replace("separation: 2", "separation: {horizontal: 2, vertical: 5}")
    .replace("fleets:", "rules: {max_height: 80}\nfleets:")
    .replace("size: 24", "size: 26")
    .replace("height: [0, 90]}}", "height: [0, 200]}}")
)

_TWO = (
    _PASSING.replace(
        "shots:\n",
        "  other: {count: 60, layout: {grid: {spacing: 4, origin: [-50, 0, 0]}}, separation: 2}\nshots:\n",
    )
    + """\
  - id: ring
    kind: display
    fleet: other
    timing: {after: shapes}
    frames: [{torus: {center: [-40, 0, 40], radius: 14, tube: 5}, hold: 5}]
  - {id: ball, kind: display, fleet: other, frames: [{sphere: {center: [-40, 0, 40], radius: 15}}]}
"""
)

_FILES = _PASSING.replace(
    "      - {text: {text: SHOTC, center: [0, 0, 40], height: 16}, hold: 4, fill: outline}\n",
    "      - {svg: {file: star.svg, center: [0, 0, 40], height: 20}}\n",
)


def _warning(info: CodeInfo) -> CodeInfo:
    return info._replace(severity=Severity.WARNING)


CODES: tuple[CodeInfo, ...] = (
    slip(
        "D001",
        "crowded-pads",
        "pads of a fleet are nearer to each other than bodies may come",
        "Pads may be nearer to each other than the fleet's separation: it then takes off in layers, one after another, "
        "and lands in them. But drones rise past others that still stand, so two pads are as far apart as two bodies "
        "need, seen from above: twice the radius, and the margin of the separation. The two nearest pads are named, by "
        "the order in which the layout gives them, and the spacing that would do. More than 64 layers are refused, "
        "too. Space the layout wider, or ask for less.",
        _MARGIN,
        ("spacing: 4", "spacing: 0.6"),
    ),
    slip(
        "D002",
        "pads-in-bodies",
        "drones of a fleet stand inside each other",
        "Two pads are nearer to each other than twice the radius of a drone's body, so no two drones can stand there. "
        "A layout in other units than metres is often the cause. Space it wider.",
        _PASSING,
        ("spacing: 4", "spacing: 0.4"),
    ),
    slip(
        "D003",
        "touching-separation",
        "a separation at which two bodies may touch",
        "The separation is measured from centre to centre. Below twice the radius of a body it is kept by drones that "
        "touch. Ask for more than that side by side and one above the other; rotors push the air down, so that the "
        "vertical distance is usually the longer one.",
        _PASSING,
        ("separation: 2", "separation: 0.4"),
    ),
    CodeInfo(
        "D004",
        "layout-rows",
        Severity.ERROR,
        "the number of rows of a layout file is not the number of drones",
        "Each row of a layout file is the pad of one drone, in the order of their numbers. The file is read whole, so "
        "a row too few or too many is a slip of either number. Correct `count`, or the file.",
        _PASSING.replace("{grid: {spacing: 4, origin: [0, 0, 0]}}", "{file: pads.csv}"),
        _PASSING,
        phase="other",
    ),
    slip(
        "D005",
        "fleets-too-near",
        "pads of two fleets are nearer to each other than their separation",
        "Drones of different fleets stay apart as well, by the wider separation of the two. The two pads that are too "
        "near are named. Move one of the layouts.",
        _TWO,
        ("origin: [-50, 0, 0]", "origin: [-29, 0, 0]"),
    ),
    slip(
        "D006",
        "blocked-pad",
        "drones of a fleet cannot rise from where they stand",
        "Every drone rises from its pad straight up by the fleet's `rise`, and comes down the same way. There, the "
        "clearance from the ground and the floors of keep-in zones do not apply, but zones to keep out of, targets "
        "and the walls and ceilings of keep-in zones do, and the ground is no place to be under. It is said how many "
        "drones are concerned, and which has least room. Move the layout, or rise less high.",
        _PASSING,
        ("origin: [0, 0, 0]", "origin: [20, 20, 0]"),
    ),
    slip(
        "D007",
        "low-rise",
        "a fleet does not rise high enough to fly",
        "From the height to which its `rise` takes it a drone goes to its picture, so there the ground clearance and "
        "the floors of keep-in zones apply, both from the body. Rise higher.",
        _PASSING,
        ("rise: 10", "rise: 2"),
    ),
    slip(
        "D027",
        "high-layers",
        "a fleet takes off in layers that reach too high",
        "A fleet whose pads are nearer to each other than its separation takes off in layers. The lowest rises by "
        "`rise`, each of the others a vertical separation higher, so many layers reach high. The highest may not be "
        "above `rules.max_height`. The wider the pads stand, the fewer layers it takes; as far apart as the separation, "
        "all rise at once. Space the layout wider, or allow more.",
        _HIGH,
        ("spacing: 4", "spacing: 0.5"),
    ),
    slip(
        "D008",
        "not-for-displays",
        "a display is given something that only cameras have",
        "A display films nothing: it has no target, composition, size, promise or refinement. How long it lasts is "
        "said by the transitions and holds of its pictures, not by `timing.duration`; and without a `viewpoint` there "
        "is nothing that `viewpoint_weight` could weigh. What has no effect is refused, since it was meant to have "
        "one. Remove it.",
        _PASSING,
        ("timing: {start: 40}", "timing: {start: 40, duration: 30}"),
    ),
    slip(
        "D009",
        "no-outline",
        "a picture without edges is to be drawn by its outline",
        "`fill: outline` puts the drones on the edges of letters, of a drawing or of a cube. What is round, and a "
        "mesh, has an inside (`volume`) and a `surface`.",
        _PASSING,
        ("radius: 15}, hold: 4", "radius: 15}, fill: outline, hold: 4"),
    ),
    CodeInfo(
        "D010",
        "no-period",
        Severity.ERROR,
        "an animation of several files has no period",
        "A pattern such as `walk/*.ply` stands for the frames of an animation, sorted as people count (2 before 10). "
        "How fast they follow each other is its `period`, in seconds, which cannot be guessed.",
        _PASSING.replace("{sphere: {center: [0, 0, 30], radius: 15}", "{model: {files: walk/*.ply}"),
        _PASSING,
        phase="other",
    ),
    slip(
        "D011",
        "unknown-format",
        "a file of a display is in a format that is not read",
        "Models are read from PLY, OBJ and STL files, drawings from SVG, fonts from TTF, OTF and TTC; the ending of "
        "the name tells which. Export it in one of these.",
        _PASSING,
        (
            "text: {text: SHOTC, center: [0, 0, 40], height: 16}",
            "svg: {file: star.png, center: [0, 0, 40], height: 16}",
        ),
    ),
    slip(
        "D012",
        "empty-display",
        "a display shows no picture",
        "`frames` lists the pictures of a display in their order; with none there is nothing to fly for.",
        _PASSING.split("      - {sphere", maxsplit=1)[0].replace(
            "    frames:\n", "    frames: [{sphere: {center: [0, 0, 30], radius: 15}}]\n"
        ),
        ("frames: [{sphere: {center: [0, 0, 30], radius: 15}}]", "frames: []"),
    ),
    slip(
        "D013",
        "viewpoint-inside",
        "the audience of a display is in the middle of a picture",
        "A picture is arranged for those who look at it from the `viewpoint`. From inside a shape there is no such "
        "picture. Spheres, cubes, rings and letters are judged here, meshes by `plan`. Correct the viewpoint, or leave "
        "it out to draw the volume for all around.",
        _PASSING,
        ("viewpoint: [0, -100, 2]", "viewpoint: [0, -5, 30]"),
    ),
    slip(
        "D014",
        "low-picture",
        "a picture reaches below the ground clearance",
        "What a picture shows has to stand clear of the ground by `rules.ground_clearance`, from the body of the lowest "
        "drone. Judged from the shape's own measures, of letters by their height. Raise its centre, or make it "
        "smaller.",
        _PASSING,
        ("sphere: {center: [0, 0, 30]", "sphere: {center: [0, 0, 15]"),
    ),
    slip(
        "D015",
        "picture-outside",
        "a picture reaches out of the heights of a keep-in zone, or is outside of it",
        "The height of a keep-in zone is the altitude band of the show, which no drone may leave, with all of its body. "
        "Judged from the shape's own measures. Move the picture, make it smaller, or the zone higher.",
        _PASSING,
        ("height: [0, 90]", "height: [0, 70]"),
    ),
    slip(
        "D016",
        "picture-in-obstacle",
        "a picture is wholly inside a keep-out zone or a target",
        "No drone may be in there, so nothing of the picture can be drawn. Move the picture, or the zone.",
        _PASSING,
        ("center: [40, 40], radius: 3, height: [0, 60]", "center: [0, 0], radius: 19, height: [12, 50]"),
        ("fleet: swarm\n", "fleet: swarm\n    pace: calm\n"),
        (
            "cube: {center: [0, 0, 65], size: 24}, transition: 12, hold: 4, fill: surface",
            "sphere: {center: [0, 0, 70], radius: 15}",
        ),
        (
            "text: {text: SHOTC, center: [0, 0, 40], height: 16}, hold: 4, fill: outline",
            "sphere: {center: [0, 0, 71], radius: 15}",
        ),
    ),
    _warning(
        slip(
            "D017",
            "picture-reaches-obstacle",
            "a picture reaches into an obstacle, or out of a keep-in zone's walls",
            "Part of the shape is where no drone may be. Whether a drone would stand there is known once they are "
            "placed, so `plan` judges; move the picture to be sure.",
            _PASSING,
            ("cube: {center: [0, 0, 65]", "cube: {center: [72, 0, 65]"),
            ("transition: 12", "transition: 30"),
        )
    )._replace(exact=("D058",)),
    slip(
        "D018",
        "too-many-drones",
        "a fleet does not fit into a picture",
        "In a picture the drones stand at least their separation apart. Balls of that size fill no more than 78 % of the room that "
        "they are given (Rogers, 1958), which bounds how many a shape can hold; on a surface, the densest covering "
        "does. Drones for which there is no room stay dark, which `plan` reports (D062); here more than 95 % would. "
        "Make the shape larger, take fewer drones, or a smaller separation.",
        _PASSING,
        ("radius: 15", "radius: 10 cm"),
    ),
    slip(
        "D019",
        "short-transition",
        "a transition is shorter than any drone could fly it",
        "From a picture to one that stands apart from it every drone has at least the distance of the boxes round them "
        "to fly, from rest to rest within the fleet's limits. That is a lower bound; a shape that overlaps the next is "
        "judged by `plan` alone. Give it more time, or leave `transition` out for as fast as the pace allows.",
        _PASSING,
        ("transition: 12", "transition: 2"),
    ),
    slip(
        "D020",
        "early-display",
        "a display starts before its fleet can be there",
        "`timing.start` is when the first picture of a display stands. The fleet has taken off by then, has shown what "
        "comes before it, and what the display waits for by `after` has ended. All these are lower bounds; `plan` knows "
        "the earliest start that can be flown.",
        _PASSING,
        ("start: 40", "start: 2"),
    ),
    slip(
        "D021",
        "long-show",
        "the displays of a fleet last longer than its drones can stay in the air",
        "Holds, transitions, animations and the ways up and down together are more than the fleet's endurance, at the "
        "least that they can take. Shorten the show, cut it in two, or take other drones.",
        _PASSING,
        ("radius: 15}, hold: 4", "radius: 15}, hold: 900"),
    ),
    CodeInfo(
        "D022",
        "unsafe-drawing",
        Severity.ERROR,
        "a drawing holds scripts, or refers to something outside of itself",
        "An SVG file can carry programs, and ask for pictures and styles from anywhere. Nothing is ever run or fetched, "
        "so a drawing with such parts would not be what its author sees; it is refused, and so is a document type "
        "declaration, whose entities could grow without bound. The note names the line of the file. Export a plain "
        "SVG, with all that it draws in the file itself.",
        _FILES,
        _PASSING,
        phase="other",
    ),
    _warning(
        slip(
            "D023",
            "idle-fleet",
            "a fleet shows nothing",
            "No display names the fleet, or the group of one, or the drones that are in no group. They stay on their pads, and "
            "others keep clear of them. Give them a display, or remove them.",
            _TWO,
            ("fleet: other", "fleet: swarm"),
            ("center: [-40, 0, 40]", "center: [0, 0, 40]"),
        )
    ),
    slip(
        "D024",
        "display-order",
        "displays wait for each other in a circle",
        "The displays of one fleet are shown in the order in which they are written, and each waits, by `after`, for "
        "another one as well. Here, one waits for what cannot come before it. Write the displays in the order in which "
        "they are shown, or drop the `after`.",
        _TWO,
        ("timing: {after: shapes}", "timing: {after: ball}"),
    ),
    CodeInfo(
        "D025",
        "model-without-units",
        Severity.ERROR,
        "nothing says how large a model is",
        "PLY, OBJ and STL files hold numbers without a unit: the same file is a person in metres and a speck in "
        "millimetres. The mission says which: `units: m` (or cm, mm, ft, in), or `height`, to which the first frame is "
        "scaled. GLB files are in metres by their format.",
        "",
        "",
        "other",
    ),
    slip(
        "D026",
        "no-layers",
        "layers are asked of a picture that is not flat",
        "`layers` puts a text or a drawing into several sheets, one behind the other, whose lights stand in each other's "
        "gaps as the audience sees them. Balls, cubes, rings and models have a depth of their own, which `fill` uses.",
        _PASSING,
        ("transition: 12, hold: 4, fill: surface}", "transition: 12, hold: 4, fill: surface, layers: 2}"),
    ),
    *pictures.CODES,
    *lights.CODES,
    *flights.CODES,
    *MUSICAL,
    *RECORDED,
    *NAMED,
    *FIRED,
    *GROUPED,
    *WAVES,
    *STANDING,
    *OWN_PADS,
)
