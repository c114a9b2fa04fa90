"""Shots of moving targets: the place that the camera keeps to them, carried along by their motion."""

from collections.abc import Sequence

from shotc.ir.limits import Vec3
from shotc.ir.mission import Ideal, Subject, Target
from shotc.kinds.base import Expansion, Scene
from shotc.spec.shot import ShotBase


def along(shot: ShotBase, scene: Scene, offsets: Sequence[Vec3]) -> Expansion:
    """Return a way told ahead of and to the left of the shot's target, which has to move.

    offsets : (ahead, left, z in W), passed evenly over the shot's time; one alone is kept
    """
    assert shot.target is not None
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    if target.track is None:
        message = f"a {shot.kind} follows a motion, but target `{target.name}` stands"
        help_ = f"give `{target.name}` a `track` instead of `at`, or use `static`, `orbit` or `dolly`"
        return Expansion.of([scene.fault("M002", message, help_, "target")])
    return timed(shot, scene, Ideal("heading", target.name, evenly(offsets)))


def timed(
    shot: ShotBase,
    scene: Scene,
    ideal: Ideal,
    subjects: tuple[Subject, ...] | None = None,
    lasts: float | None = None,
) -> Expansion:
    """Return the expansion of a shot on its own clock; it has to say how long it lasts.

    subjects : None for the shot's own target; lasts : seconds where the timing does not say, if there is
    a usual time
    """
    if shot.timing.duration is None and lasts is None:
        message = f"how long does this {shot.kind} last? its target moves, so its time is the mission's"
        return Expansion.of([scene.lasting("M003", message, "kind")])
    if subjects is None:
        subjects = () if shot.target is None else (scene.framed(shot, shot.target),)
    return Expansion(ideal=ideal, subjects=subjects, lasts=lasts)


def evenly(points: Sequence[Vec3]) -> tuple[tuple[float, Vec3], ...]:
    """Return points with the shares of the time at which they are passed; one alone is kept throughout."""
    every = (points[0], points[0]) if len(points) == 1 else tuple(points)
    return tuple((i / (len(every) - 1), p) for i, p in enumerate(every))
