"""What time shots need to be refined, where a mission leaves it free and others were planned beside them.

Then a refined shot keeps the time of its convex path. One that cannot says so, and the mission's paths are
planned again with that shot as long as it needs.
"""

from __future__ import annotations

from dataclasses import replace

from shotc.ir.path import PathIR

NEEDS = ".needs"  # of a statistic's name, after the shot's
MORE = 1.02  # times what was needed, for the way is another again


def with_need(path: PathIR, shot: str, seconds: float) -> PathIR:
    """Return the path with a note that a shot, were it refined, would take so long."""
    return replace(path, stats=(*path.stats, (f"{shot}{NEEDS}", seconds)))


def needed(path: PathIR) -> dict[str, float]:
    """Return the durations with which shots of a refined path could be refined that are not, by id."""
    mission, needs = path.keyframes.mission, {}
    for name, value in path.stats:
        shot = name.removesuffix(NEEDS)
        if name != shot and isinstance(value, float) and mission.shot(shot).timing.duration is None:
            needs[shot] = MORE * value
    return needs
