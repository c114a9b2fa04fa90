"""The duration that a shot needs for its refinement, if the mission leaves it free.

A refined shot keeps the duration of its convex path if other shots are planned beside it. If it cannot, the
refiner notes the duration that it needs, and all paths of the mission are planned again with it.
"""

from __future__ import annotations

from dataclasses import replace

from shotc.ir.path import PathIR

NEEDS = ".needs"  # suffix of the statistic's name, after the shot's id
MORE_RATIO = 1.02  # factor on the needed duration, because the new path differs again


def with_need(path: PathIR, shot: str, seconds: float) -> PathIR:
    """Return the path with a note of the duration, seconds, that the refinement of a shot needs."""
    return replace(path, stats=(*path.stats, (f"{shot}{NEEDS}", seconds)))


def needed(path: PathIR) -> dict[str, float]:
    """Return by id the durations, seconds, with which the unrefined shots of a path could be refined."""
    mission, needs = path.keyframes.mission, {}
    for name, value in path.stats:
        shot = name.removesuffix(NEEDS)
        if name != shot and isinstance(value, float) and mission.shot(shot).timing.duration is None:
            needs[shot] = MORE_RATIO * value
    return needs
