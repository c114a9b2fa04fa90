"""Sizes that a shot asks for but its geometry does not give: warnings with remedies."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, hypot
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.camera import aim_at, view
from shotc.geom.vec import Vec2, Vec3
from shotc.geom.viewpoint import Lens, RequiredView, distance_for, lens_for, nearest
from shotc.ir.begins import first_start
from shotc.ir.drone import Drone
from shotc.ir.framed_scene import lens_of
from shotc.ir.ideal import ideal_place
from shotc.ir.keyed import arrivals, is_keyed
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import MissionIR, frozen
from shotc.spec.words import each

SHOT_SAMPLES = 40  # samples of a shot on its own clock
OFF_SIZE_SHARE = 0.1  # relative error of the size, above which there is a warning


class SizeCase(NamedTuple):
    """A camera's view of a target: its size, the camera's offset, and the framing.

    offset : camera minus target's centre
    """

    size: float
    name: str
    offset: Vec3
    uv: Vec2 | None
    lens: Lens


def check_size(mission: MissionIR, placed: PlacedShot) -> Diagnostic | None:
    """Return the warning about a shot whose target does not have the requested size, or None."""
    shot, required = placed.shot, placed.shot.size
    if required is None or (shot.ideal is not None and shot.ideal.framed):
        return None
    looks = list(_at_keyframes(mission, placed) if placed.keyframes else _on_clock(mission, placed))
    if not looks:
        return None
    worst = max(looks, key=lambda look: abs(look.size / required - 1.0))
    if abs(worst.size / required - 1.0) <= OFF_SIZE_SHARE:
        return None
    low, high = min(look.size for look in looks), max(look.size for look in looks)
    sizes = f"{low:.3g} to {high:.3g}" if high - low > 0.01 * high else f"{worst.size:.3g}"
    return Diagnostic(
        "M035",
        f"the size of `{worst.name}` in shot `{shot.id}` is {sizes}, not {required:.3g}",
        (mission.origins.value((*shot.path, "size")),),
        (
            "other numbers of the shot decide how far away the camera is",
            _instead(mission, worst, required),
        ),
        f"{_numbers(mission, placed, looks, required)}, or leave `size` out"
        f"{_framed(mission, placed, required)}",
    )


def _numbers(mission: MissionIR, placed: PlacedShot, looks: list[SizeCase], required: float) -> str:
    """Return the lens that gives a target of one size all along the size that is asked for, in words."""
    look = looks[0]
    same = all(abs(other.size / look.size - 1.0) <= OFF_SIZE_SHARE for other in looks)
    subject = RequiredView(mission.target(look.name).centre, mission.target(look.name).shape, look.uv)
    hfov = lens_for(subject, look.lens, look.offset, required) if same else None
    if hfov is None or any((*k.path, "hfov") in mission.origins.values for k in placed.shot.keyframes):
        return "change those numbers or the lens"
    return f"film it with `camera: {{hfov: {degrees(hfov):.1f} deg}}` of `{placed.shot.drone}`"


def _framed(mission: MissionIR, placed: PlacedShot, required: float) -> str:
    """Return the framing that gives the target its size, for a shot with one target and a duration."""
    shot, written = placed.shot, mission.origins.keys
    names = {subject.target for subject in placed.subjects} | {k.target for k in placed.keyframes} - {None}
    if len(names) > 1 or shot.timing.duration is None:
        return ""
    shared = ("id", "kind", "drone", "timing", "pace", "require", "refine", "allow")
    own = [str(path[-1]) for path in written if path[:-1] == shot.path and path[-1] not in shared]
    subject = f"{{target: {names.pop()}, size: {required:.3g}}}"
    return f", or write `kind: framing, subjects: [{subject}]` in place of {each(own)}"


def _instead(mission: MissionIR, look: SizeCase, required: float) -> str:
    """Return the distance and the lens that would give a target its size."""
    target = mission.target(look.name)
    subject = RequiredView(target.centre, target.shape, look.uv)
    distance = hypot(*look.offset)
    x, y, z = (c / distance for c in look.offset)
    far = distance_for(subject, look.lens, (x, y, z), required)
    said = (
        f"its size is {look.size:.3g} from {distance:.1f} m away; it would be {required:.3g} from {far:.1f} m"
    )
    if far < nearest(subject, (x, y, z), mission.rules.target_clearance):
        said += ", which is too near"
    hfov = lens_for(subject, look.lens, look.offset, required)
    return said if hfov is None else f"{said}, or from there with `hfov: {degrees(hfov):.0f} deg`"


def _on_clock(mission: MissionIR, placed: PlacedShot) -> Iterator[SizeCase]:
    """Yield the views of the first subject along the ideal of a shot on its own clock."""
    shot = placed.shot
    if shot.ideal is None or not placed.subjects:
        return
    start, duration = first_start(mission, shot), shot.timing.duration or 0.0
    subject, drone = placed.subjects[0], mission.drone(shot.drone)
    for i in range(SHOT_SAMPLES + 1):
        t = start + duration * i / SHOT_SAMPLES
        eye = ideal_place(mission, shot, start, t)
        then = frozen(mission, t)
        x, y, z = (e - c for e, c in zip(eye, then.target(subject.target).centre, strict=True))
        look = _look(then, subject.target, (x, y, z), subject.reference, lens_of(drone), shot.ideal.aim)
        if look is not None:
            yield look


def _at_keyframes(mission: MissionIR, placed: PlacedShot) -> Iterator[SizeCase]:
    """Yield the views of the targets at the keyframes of a shot."""
    shot, drone = placed.shot, mission.drone(placed.shot.drone)
    times = arrivals(shot) if is_keyed(shot) else (0.0,) * len(placed.keyframes)
    start = first_start(mission, shot)
    for keyframe, t in zip(placed.keyframes, times, strict=True):
        then = frozen(mission, start + t)
        look = None if keyframe.target is None else _from_keyframe(then, drone, keyframe, keyframe.target)
        if look is not None:
            yield look


def _from_keyframe(mission: MissionIR, drone: Drone, keyframe: PlacedKeyframe, name: str) -> SizeCase | None:
    x, y, z = (e - c for e, c in zip(keyframe.at, mission.target(name).centre, strict=True))
    lens = lens_of(drone)._replace(hfov=keyframe.hfov)
    return _look(mission, name, (x, y, z), keyframe.reference, lens, (keyframe.yaw, keyframe.pitch))


def _look(
    mission: MissionIR, name: str, offset: Vec3, uv: Vec2 | None, lens: Lens, aim: Vec2 | None
) -> SizeCase | None:
    """Return a camera's view of a target; None where the target reaches behind the camera."""
    target = mission.target(name)
    back = (-offset[0], -offset[1], -offset[2])
    aim = aim or aim_at(back, uv or (0.0, 0.0), lens.hfov, lens.aspect)
    if aim is None:
        return None
    camera = view(*aim, lens.hfov, lens.aspect)
    if target.shape.nearest_depth(camera, back) <= 0:
        return None
    _, _, low, high = target.shape.bounds(camera, back)
    return SizeCase(0.5 * (high - low), name, offset, uv, lens)
