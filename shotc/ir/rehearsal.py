"""What a mission asks of its rehearsals, and under which conditions they are flown. Plain Python.

`simulate` alone reads it: no plan depends on it, and no proof.
"""

from typing import Literal, NamedTuple

from shotc.ir.origin import KeyPath

Loop = Literal["replay", "track", "replan"]
VehicleName = Literal["lag", "rotorpy"]
Receiver = Literal["rtk", "plain"]


class Wind(NamedTuple):
    """Wind over the whole mission.

    speed : m/s; toward : yaw of the direction in which it blows, rad counter-clockwise from East; None where
        the mission does not say
    """

    speed: float
    toward: float | None = None


class RehearsalPromise(NamedTuple):
    """What has to hold in a share of the runs; None asks for nothing.

    in_frame : least share of the frames of each shot with the whole target in them, 0 to 1
    in_sight : least share of the instants of each shot at which half of the target's outline or more is free
    mean_error : largest mean over the frames of a shot of the distance on screen between target and reference
    clearance : least distance from a drone's body to all else, metres; of fleets, from drone to drone
    stray : largest distance of a drone from where the plan has it at the same time, metres
    of : the share of the runs, 0 to 1
    """

    in_frame: float | None = None
    in_sight: float | None = None
    mean_error: float | None = None
    clearance: float | None = None
    stray: float | None = None
    of: float = 1.0


class Rehearsal(NamedTuple):
    """A rehearsal as the mission asks for it.

    runs : how many; wind : None where it is that of the world; gusts : standard deviation of each axis, m/s
    gps : the receivers of drones and targets; wander : standard deviation of how far what moves is off its
        track, metres
    """

    promise: RehearsalPromise
    path: KeyPath
    runs: int
    loop: Loop
    wind: Wind | None
    gusts: float
    gps: Receiver
    wander: float
