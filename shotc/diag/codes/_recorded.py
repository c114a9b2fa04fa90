"""D150 to D156: flights of whole fleets from other tools. A mission shows them only together with a file."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity


def _code(number: int, slug: str, summary: str, explanation: str, *, warns: bool = False) -> CodeInfo:
    severity = Severity.WARNING if warns else Severity.ERROR
    return CodeInfo(f"D{number}", slug, severity, summary, explanation, "", "", "other")


RECORDED: tuple[CodeInfo, ...] = (
    _code(
        150,
        "flight-file-unread",
        "the file of a recorded flight cannot be read",
        "`frames: {flight: FILE}` takes zipped CSV, a table `Time [msec],x [m],y [m],z [m],Red,Green,Blue` for each drone, or "
        "a `.skyc` of version 1. At most 200 MB, 20,000 drones and 5 million rows are read. The note names the part of the "
        "archive and its line. Export the show again from the program that made it.",
    ),
    _code(
        151,
        "flight-of-others",
        "a recorded flight does not have one track for each drone of the fleet",
        "Every drone keeps the track and the light of one drone of the file, so there are as many of both. "
        "`shotc import show FILE` writes a mission with the right number and the pads of the file.",
    ),
    _code(
        152,
        "flight-on-the-ground",
        "the drones of a recorded flight are never all in the air",
        "A fleet takes off together and lands together: from the time at which the last drone is as high as the ground "
        "clearance until the first one is below it, the show is flown. A drone that never rises, or groups that fly one "
        "after the other, leave no such time.",
    ),
    _code(
        153,
        "flight-jumps",
        "a drone of a recorded flight jumps",
        "Where drones are too fast for their limits, all of them take more time there. A place that would take more than 20 "
        "times as long is no movement but a fault of the file: a segment is lost between two others, or a time has a slip.",
    ),
    _code(
        154,
        "flight-slower",
        "a recorded flight is slower than in its file, so that its drones keep their limits",
        "Time is stretched where a drone would break a limit, for all drones alike: the formations stay those of the file, "
        "in their order, and drones that are apart in one stay apart. Elsewhere the times of the file stay. The worst place "
        "is named, with the limit and how much longer the whole takes.",
        warns=True,
    ),
    _code(
        155,
        "flight-without-own-take-off",
        "the take-off or the landing of a recorded flight is not flown as recorded",
        "Fleets rise and land straight over their pads, and are proved to. Where the file has drones that lean, or that set "
        "out before all are clear of the ground, the fleet rises from its pads, comes to the first formation in the air by "
        "itself, and goes on as recorded; so it does after the last one.",
        warns=True,
    ),
    _code(
        156,
        "flight-too-near",
        "two drones of a recorded flight come too near to each other",
        "Drones that pass too near are moved apart, as little as does, where their limits leave room. Where they stand too "
        "near, or nothing helps, the two are named, with the time of the mission and their distance. The separation is what "
        "the fleet asks for: tools that made the show may have asked for less.",
    ),
)
