"""I: missions of other tools. A mission of shotc cannot show these codes. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity


def _code(number: int, slug: str, summary: str, explanation: str) -> CodeInfo:
    severity = Severity.WARNING if number == 4 else Severity.ERROR
    return CodeInfo(f"I{number:03}", slug, severity, summary, explanation, "", "", "other")


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "import-unreadable",
        "a file to import cannot be read",
        "Importers read at most 4 MB. XML has no document type, so no entities. `multidrone` reads 100 shooting actions "
        "with 200 roles and 2000 points, the others 10,000 cameras: more is no mission. Of a KMZ the first document is "
        "read, no further than 4 MB. The message says what the file is instead, or where it breaks off. Export it again.",
    ),
    _code(
        2,
        "import-foreign",
        "a file to import is of another sort",
        "A mission of the MultiDrone project is XML with the root `mission`, a tour has the root `kml`, a plan of "
        "QGroundControl is JSON with `mission` and `items`, and tables of Blender and Litchi name their columns in "
        "their first line. This file can be read, but is none of the sort that was asked for.",
    ),
    _code(
        3,
        "import-empty",
        "a file to import holds nothing to film",
        "A mission is made of shooting actions that say where their target goes, or where their formation begins; or of "
        "a tour, an animation or waypoints with two cameras or more, for a shot goes from one to another. This file has "
        "none that can be read.",
    ),
    _code(
        4,
        "import-assumed",
        "something in an imported file had to be assumed",
        "The file leaves something open, contradicts itself or has a slip in it: a decimal comma, a missing value, "
        "times that do not rise, a speed that is not that of the times, two frames of reference. What is taken instead stands in the message, and as a "
        "comment in the mission, where it is easily changed. `--strict` refuses instead.",
    ),
    _code(
        5,
        "import-ambiguous",
        "something in an imported file would have to be assumed, which --strict forbids",
        "With `--strict` nothing is assumed: whatever is missing, wrong or ambiguous in the file is an error. Correct the "
        "file, or import it without `--strict` and look at the comments in the mission.",
    ),
    _code(
        6,
        "import-impossible",
        "an imported file asks for what cannot be flown",
        "What an importer writes is a mission that `shotc check` accepts. Where check finds errors that no assumption "
        "can correct, nothing is written; the errors are those of the mission that was made.",
    ),
    _code(
        7,
        "import-mixed-heights",
        "heights of a file to import do not count from one level",
        "Some heights count from sea level, others from the ground or from a home, and nothing in the file says how "
        "high that is. `--ground` gives its altitude, so that all of them count from it.",
    ),
    _code(
        8,
        "flight-unreadable",
        "the file of a flight cannot be read",
        "`shotc verify FILE --against MISSION` reads files of waypoints of at most 4 MB and 2000 points, and tables and "
        "shows of at most 200 MB. XML has no document type, so no entities; of a `.kmz` the `wpmz/waylines.wpml` is "
        "read, of a `.skyc` the `show.json`, no further than these sizes. The message says what the file is instead, "
        "or where it breaks off. Export it again.",
    ),
    _code(
        9,
        "flight-foreign",
        "the file of a flight is of another sort or version",
        "A `.plan` is JSON with `mission` and `items` for PX4 or ArduPilot, a `.waypoints` begins with `QGC WPL 110`, a "
        "`.kmz` holds one wayline of WPML 1.0.0 to 1.0.6, a `.skyc` a show of version 1, and a table of Litchi or of "
        "trajectories names its columns in its first line: `t_s,drone,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s`, of which the "
        "time and the place are needed. This file can be read, but is none of these.",
    ),
    _code(
        10,
        "flight-broken",
        "an element of a flight is broken, or moves the machine in a way that is not known",
        "Where a waypoint has no place, a number is none, or an item is a jump or a circle, nobody can say where the "
        "machine goes, and nothing is assumed. The label is on the element. Correct it, or fly that part by another file.",
    ),
    _code(
        11,
        "flight-heights",
        "heights of a flight do not count from one known level",
        "Heights that count from the take-off differ from those that count from sea level or from the ground by what is "
        "known at take-off only. Heights over the ellipsoid, or over terrain that the machine follows by its own map, "
        "cannot be tied to the mission's ground. Let all waypoints count from the take-off.",
    ),
    _code(
        12,
        "flight-far",
        "a waypoint is far from the mission",
        "A waypoint more than 20 km from the drone's pad belongs to another mission, or its latitude and longitude are "
        "exchanged, or zero. Look at the file, and at `world.origin` of the mission.",
    ),
    _code(
        13,
        "flight-of-nobody",
        "it is not known to which drone a file of a flight belongs",
        "A file is of the drone that it is named after, `cam1.kmz` of `cam1`; the parts of one flight are `cam1-1.kmz`, "
        "`cam1-2.kmz`. Where the mission has one drone, every file is of that one. `--drone NAME`, once for every file, "
        "says it otherwise. Tables and shows name their drones; a show's drones with other names are those on whose pads "
        "they stand. Two files cannot be the same part of one flight, and a fleet flies as a whole: as many flights as "
        "it has drones.",
    ),
    _code(
        14,
        "flight-without-origin",
        "a flight has latitudes, and the mission has no place on earth",
        "Waypoints stand at latitudes and longitudes. `world: {origin: {lat: ..., lon: ..., alt: ...}}` ties the "
        "mission's metres to the globe.",
    ),
)
