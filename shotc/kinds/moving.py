"""Shots of moving targets: the ideal relative to their motion."""

from collections.abc import Sequence
from itertools import pairwise

from shotc.ir.ground import Above
from shotc.ir.keyed import KEYED, stays
from shotc.ir.limits import Vec3
from shotc.ir.mission import Ideal, Subject
from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Scene
from shotc.spec.shot import ShotBase


def along(shot: ShotBase, scene: Scene, offsets: Sequence[Vec3], above: Above | None = None) -> Expansion:
    """Return the expansion of a way relative to the heading of the shot's target, which must move.

    offsets : (ahead, left, up), passed evenly over the shot's time; a single one is constant
    above : reference of up; None for the target's foot at that time
    """
    assert shot.target is not None
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    if target.track is None:
        message = f"a {shot.kind} follows a motion, but target `{target.name}` stands"
        help_ = f"give `{target.name}` a `track` instead of `at`, or use `static`, `orbit` or `dolly`"
        return Expansion.of([scene.fault("M002", message, help_, "target")])
    return timed(shot, scene, Ideal("heading", target.name, evenly(offsets), above=above or "target"))


def timed(
    shot: ShotBase,
    scene: Scene,
    ideal: Ideal,
    subjects: tuple[Subject, ...] | None = None,
    duration: float | None = None,
) -> Expansion:
    """Return the expansion of a shot on its own clock, which needs a duration.

    subjects : None for the shot's own target; duration : the default one, seconds, or None
    """
    if shot.timing.duration is None and duration is None:
        message = f"how long does this {shot.kind} last? its target moves, so its time is the mission's"
        return Expansion.of([scene.lasting("M003", message, "kind")])
    if subjects is None:
        subjects = () if shot.target is None else (scene.framed(shot, shot.target),)
    return Expansion(ideal=ideal, subjects=subjects, duration=duration)


def on_clock(shot: ShotBase, scene: Scene, given: Expansion) -> Expansion:
    """Return keyframes with moving targets as a shot on its own clock; a still camera repeats its keyframe.

    Without another duration, the last keyframe's time and hold determine it.
    """
    keyframes, duration = given.keyframes, given.duration
    last = keyframes[-1]
    if duration is None and last.time is not None:
        duration = last.time + last.hold
    if len(keyframes) == 1:
        duration = last.hold
        keyframes = (last._replace(hold=0.0), last._replace(hold=0.0))
    named = {k.target: k for k in reversed(keyframes) if k.target is not None}
    subjects = tuple(
        Subject(k.target, k.composition, shot.size, None, k.path)
        for k in reversed(named.values())
        if k.target is not None
    )
    # The author's keyframes do not determine the ways between them, unless the camera stays in one place.
    placed = shot.kind != "keyframes" or all(stays(a, b) for a, b in pairwise(keyframes))
    expansion = timed(shot, scene, KEYED._replace(placed=placed), subjects, duration)
    return expansion if expansion.ideal is None else expansion._replace(keyframes=keyframes)


def evenly(points: Sequence[Vec3]) -> tuple[tuple[float, Vec3], ...]:
    """Return points with evenly spaced shares of the time; a single point is kept for the whole time."""
    every = (points[0], points[0]) if len(points) == 1 else tuple(points)
    return tuple((i / (len(every) - 1), p) for i, p in enumerate(every))
