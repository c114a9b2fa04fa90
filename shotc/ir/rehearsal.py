"""The requirements of a mission on its rehearsals, and the conditions of their runs. Plain Python.

Only `simulate` reads it. No plan and no proof depends on it.
"""

from typing import Literal, NamedTuple

from shotc.ir.origin import KeyPath

Loop = Literal["replay", "track", "replan"]
VehicleName = Literal["lag", "rotorpy"]
Receiver = Literal["rtk", "plain"]


class Wind(NamedTuple):
    """Wind over the whole mission.

    speed : m/s; toward : yaw of the direction in which it blows, rad counter-clockwise from East; None if
        unknown
    """

    speed: float
    toward: float | None = None


class RehearsalPromise(NamedTuple):
    """The requirements that must hold in a share of the runs; None requires nothing.

    in_frame : least share of frames with the whole target in them, for each shot, 0 to 1
    in_sight : least share of samples with at least half of the target's outline free, for each shot
    mean_error : largest mean distance on screen between target and reference, for each shot
    clearance : least distance from a drone's body to everything else, metres; for fleets, between drones
    stray : largest distance of a drone from its planned position at the same time, metres
    of : share of the runs, 0 to 1
    """

    in_frame: float | None = None
    in_sight: float | None = None
    mean_error: float | None = None
    clearance: float | None = None
    stray: float | None = None
    of: float = 1.0


class Rehearsal(NamedTuple):
    """A rehearsal as the mission requires it.

    runs : their number; wind : None for that of the world; gusts : standard deviation of each axis, m/s
    gps : the receivers of drones and targets; wander : standard deviation of a moving target's distance from
        its track, metres
    """

    promise: RehearsalPromise
    path: KeyPath
    runs: int
    loop: Loop
    wind: Wind | None
    gusts: float
    gps: Receiver
    wander: float
