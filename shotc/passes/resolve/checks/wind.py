"""Wind as the cause of an infeasible duration: how much less of it would be feasible."""

from shotc.ir.drone import Drone
from shotc.ir.limits import Limits
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.motion import least_shot
from shotc.rounding import at_least, down

FASTEST_M_S = 100.0  # m/s, above which speed is not the cause


def less_wind(mission: MissionIR, shot: Shot, drone: Drone, seconds: float) -> list[str]:
    """Return remedies with less wind and with more speed, for which a shot takes at most ``seconds``.

    Empty where the wind is at most half of the drone's speed, or where no speed is sufficient.
    """
    limits, wind, taken = drone.limits, mission.wind, mission.wind_taken
    if wind <= (limits.speed + taken) / 2:
        return []
    needed = _needed(shot, limits, seconds)
    if needed is None:
        return []
    faster = f"take a drone that flies more than {at_least(needed + taken, 1)} m/s"
    calm = down(limits.speed + taken - needed if taken else wind * _calmer(shot, limits, seconds), 1)
    return [f"wait for wind below {calm:.1f} m/s", faster] if calm > 0 else [faster]


def _calmer(shot: Shot, limits: Limits, seconds: float) -> float:
    """Return the largest share of the wind in which a shot may take ``seconds``, by bisection; 0 if none."""

    def takes(share: float) -> float:
        wind = (share * limits.wind[0], share * limits.wind[1])
        return least_shot(shot.keyframes, limits._replace(wind=wind))

    low, high = 0.0, 1.0
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (middle, high) if takes(middle) <= seconds else (low, middle)
    return low


def _needed(shot: Shot, limits: Limits, seconds: float) -> float | None:
    """Return the least horizontal speed with which a shot may take ``seconds``, m/s, by bisection, or
    None.
    """

    def takes(speed: float) -> float:
        return least_shot(shot.keyframes, limits._replace(speed=speed))

    low, high = limits.speed, FASTEST_M_S
    if takes(high) > seconds:
        return None
    while high - low > 1e-4:
        middle = (low + high) / 2
        low, high = (low, middle) if takes(middle) <= seconds else (middle, high)
    return high
