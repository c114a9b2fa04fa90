"""I: missions of other tools. A mission of ours cannot show these codes. See shotc.diag.registry."""

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
        "something in an imported file would have to be assumed, and nothing may be",
        "With `--strict` nothing is assumed: whatever is missing, wrong or ambiguous in the file is an error. Mend the "
        "file, or import it without `--strict` and look at the comments in the mission.",
    ),
    _code(
        6,
        "import-impossible",
        "an imported file asks for what cannot be flown",
        "What an importer writes is a mission that `shotc check` accepts. Where check finds errors that no assumption "
        "can mend, nothing is written; the errors are those of the mission that was made.",
    ),
    _code(
        7,
        "import-mixed-heights",
        "heights of a file to import do not count from one level",
        "Some heights count from sea level, others from the ground or from a home, and nothing in the file says how "
        "high that is. `--ground` gives its altitude, so that all of them count from it.",
    ),
)
