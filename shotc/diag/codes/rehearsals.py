"""W: rehearsals, simulated flights of plans in wind."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

CODES: tuple[CodeInfo, ...] = (
    CodeInfo(
        "W001",
        "rehearsal-not-kept",
        Severity.ERROR,
        "too few runs of a rehearsal keep what the mission asks of them",
        "`shotc simulate` flies a plan many times: drones lag behind it, wind and gusts push them, receivers and "
        "cameras err, subjects leave their track. What stands under `rehearse: {require: ...}` has to hold in the "
        "share of the runs that `of` gives, and in all of them without it. It judges rehearsals alone: `plan` and "
        "`verify` prove the plan and do not read it. The help says what as many runs do keep.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W002",
        "rehearsal-touches",
        Severity.ERROR,
        "in a rehearsal a drone touches something",
        "The body of a drone comes to what stands, to a target or to another drone in at least one run, and more runs "
        "than `rehearse: {require: {of: ...}}` lets pass. The plan itself keeps its clearances; in this wind the drone "
        "does not keep to the plan closely enough. Plan with larger clearances, or fly in less wind.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W003",
        "wind-too-strong",
        Severity.ERROR,
        "the wind of a rehearsal is as fast as a drone flies",
        "A drone in a wind that is as fast as it flies cannot hold its place, so nothing is flown. `world.wind` is "
        "taken off the speed of every drone; a rehearsal may blow harder than that, but not harder than the drone.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W004",
        "impossible-truth",
        Severity.ERROR,
        "the true track of a target in a rehearsal ends early or jumps",
        "`shotc simulate --truth TARGET=FILE` says where a target really goes while the plan believes its own track. "
        "The file has to reach from the mission's start to the last landing, and nothing that is filmed jumps.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W006",
        "no-cluster",
        Severity.ERROR,
        "the scheduler of a cluster does not answer",
        "`--workers tcp://HOST:PORT` hands the runs of `shotc simulate`, or the missions of `shotc plan FOLDER`, to the "
        "Dask scheduler at that address, which has to answer within ten seconds. Start one with `dask scheduler`, and workers with `dask worker tcp://HOST:PORT` in an environment "
        "that has the same shotc.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W007",
        "worker-lost",
        Severity.ERROR,
        "a process was killed while it worked beside others",
        "`shotc simulate` and `shotc plan FOLDER` work in several processes. One of them is gone before its work was done: "
        "somebody killed it, or the machine has too little memory for so many. What the others had done is kept; the same "
        "command goes on from there.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W008",
        "left-behind",
        Severity.WARNING,
        "in a rehearsal a drone falls behind its subject",
        "With `--loop replan` a drone follows its subject within its own limits. It has fallen behind where its "
        "distance from the subject exceeds the planned one by more than half: the subject then has two thirds of "
        "its planned size on screen. The camera may still keep it in frame. The notes give the reason where it is "
        "known: the subject moves faster than the drone may fly over ground in that direction (`limits.speed`, "
        "with the wind), its positions are lost, or replans fail. Speeds are averaged over a second.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W009",
        "misled-by-receiver",
        Severity.WARNING,
        "in a rehearsal the errors of its receiver lead a drone off its plan by more than a clearance",
        "A drone flies to where its receiver says that its plan is. Farther off the plan than the least clearance "
        "that the mission needs (from the ground, targets, scenes and buildings, and other drones; at least 0.5 m "
        "counts), it can touch what the plan is proved to be clear of. Only strays count of which the receiver's error is at least half; "
        "replanned shots and the ways back from them leave the plan on purpose and do not count. `--gps` and "
        "`--bias` of `shotc simulate` choose the receivers.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W010",
        "replanner-fails",
        Severity.WARNING,
        "in a rehearsal a replanner gives a drone no plan",
        "With `--loop replan` a replanner plans the next seconds of a drone twice a second. It fails where it "
        "says so, raises an exception, returns something that cannot be flown (numbers that are not finite, "
        "another number of stages), ends its process, or takes more than 10 s. Replanners of other packages run "
        "in a process of their own, which is killed then, and a replanner that took too long is not asked again "
        "in that shot of that run. The drone flies its last plan to the end, brakes and holds. "
        "`simulate.json` has the number of failed replans of every run.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "W011",
        "position-lost",
        Severity.WARNING,
        "in a rehearsal a drone has no satellite positions for a while",
        "`shotc simulate --lost 20:25` takes the satellite positions from all drones and targets, `--lost cam=20:25` "
        "from one. A drone goes on by its inertial sensors, whose error grows: 0.8 m on each axis after 5 s (one "
        "standard deviation). After 2 s it brakes and holds, as well as it knows its place; a drone that lands over "
        "its pad goes on landing. When positions are back it returns to its plan, straight and without a look at "
        "what is in between: the nearest things of each run show whether there is room. Real autopilots differ: some "
        "land where they are.",
        "",
        "",
        "other",
    ),
)
