"""Diagnostics of infeasible compositions, and of stated turns during which the camera loses its target.

Keyframes that share a line of the mission, as generated ones do, are reported once, for the worst of them.
"""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from math import degrees, hypot, pi, radians
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.camera import heading_of
from shotc.geom.vec import TURN_RAD, Vec2, wrapped
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.limits import reaches
from shotc.ir.mission import Composition, Keyframe, MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.labels import framing_label
from shotc.passes.place_keyframes.farther import Fits, farther, least, parameter_label
from shotc.planning.framing.candidates import (
    TOUCH_M,
    FixedCamera,
    has_candidate,
    nearest_candidate,
    nearest_on_verticals,
    roomiest,
)
from shotc.planning.framing.placing import Unmet
from shotc.rounding import at_least, at_most

WIDEST_RAD = radians(150)
_WARNINGS = ("G011", "G012")


class Miss(NamedTuple):
    """One keyframe that misses its composition; of several the one with the largest weight is reported.

    help : the remedy, or a function that searches it in the mission and the shot
    """

    code: str
    keyframe: Keyframe
    weight: float
    message: str
    notes: tuple[str, ...] = ()
    help: Callable[[MissionIR, Shot], str] | str = ""


def missed(unmet: Unmet) -> Miss:
    """Return the report on a keyframe whose composition is infeasible."""
    keyframe, setting, aim, requested, place = unmet
    if requested is None:
        return cropped_or_beyond(keyframe, setting, aim)
    return (
        does_not_fit(keyframe, setting, requested)
        if place is None
        else off_composition(keyframe, setting, requested, place)
    )


def off_composition(keyframe: Keyframe, setting: FixedCamera, requested: Vec2, place: Vec2) -> Miss:
    """Return the warning that the target stands off its set: it would be cropped, or is out of reach."""
    instead = f"it is shown whole at ({place[0]:.3f}, {place[1]:.3f}) instead, {_range(setting)}"
    free = setting._replace(pitch=(-pi / 2, pi / 2))
    if _no_angles(free, keyframe.composition):
        return _straight_over("G011", keyframe, setting, instead)
    alternative = nearest_candidate(free, keyframe.composition, requested)
    aim = None if alternative is None else free.aim(alternative)
    if aim is not None:
        return Miss(
            "G011",
            keyframe,
            _excess(setting, aim[1]),
            f"the gimbal cannot pitch to put target `{keyframe.target}` on `{keyframe.composition.name}`",
            (_reach(setting, aim[1]), instead),
            _within_reach(setting, aim[1]),
        )
    return Miss(
        "G011",
        keyframe,
        abs(place[1]),
        f"target `{keyframe.target}` would be cropped at every place of `{keyframe.composition.name}`",
        (instead,),
        partial(_what_fits_or_keep, keyframe, setting),
    )


def _to_keep(keyframe: Keyframe, mission: MissionIR) -> str:
    """Return how to keep a place on screen; a keyframe's own `frame` precedes its shot's composition."""
    own = (*keyframe.path, "frame") in mission.origins.values
    return "write `frame: keep`" if own else "set `composition: keep`"


def cropped_or_beyond(keyframe: Keyframe, setting: FixedCamera, aim: Vec2) -> Miss:
    """Return the error of a kept framing out of the gimbal's range, or the warning that it crops its
    target.
    """
    if not reaches(setting.pitch, aim[1]):
        return _beyond_gimbal(keyframe, setting, aim)
    over = -setting.margin(aim)
    return Miss(
        "G012",
        keyframe,
        over,
        f"target `{keyframe.target}` is cropped by `{keyframe.composition.name}`",
        (f"it reaches {over:.2f} m out of the frame, {_range(setting)}",),
        partial(_all_of_it, keyframe, setting, aim),
    )


def _all_of_it(keyframe: Keyframe, setting: FixedCamera, aim: Vec2, mission: MissionIR, shot: Shot) -> str:
    """Return the angles, the place and the lens of which each alone shows the whole target."""
    options = (
        _towards(keyframe, setting),
        farther(mission, shot, keyframe, setting, lambda s: s.margin(aim) >= -TOUCH_M),
        *_wider(keyframe, setting, aim, (mission, shot)),
    )
    return ", or ".join(option for option in options if option) or "make the target smaller"


def _towards(keyframe: Keyframe, setting: FixedCamera) -> str:
    """Return the angles straight at a target, where they show all of it; else empty."""
    straight = setting.aim((0.0, 0.0))
    if straight is None or not keyframe.placed or not reaches(setting.pitch, straight[1]):
        return ""
    compass, pitch = round(degrees(heading_of(straight[0]))), round(degrees(straight[1]))
    written = (radians(90.0 - compass), radians(pitch))
    if not reaches(setting.pitch, written[1]) or setting.margin(written) < -TOUCH_M:
        return ""
    return f"write `heading: {compass} deg, pitch: {pitch} deg`"


def _wider(
    keyframe: Keyframe, setting: FixedCamera, aim: Vec2, where: tuple[MissionIR, Shot]
) -> Iterator[str]:
    """Yield which lens shows the whole target at the same angles, if the drone may have it.

    where : the mission and the shot
    """
    widest = _widest(*where)
    if setting.hfov >= widest:
        return
    wide = least(lambda a: setting._replace(hfov=a).margin(aim) >= -TOUCH_M, setting.hfov, widest)
    yield "widen `hfov`" if wide is None else _lens(*where, keyframe, wide)


def _lens(mission: MissionIR, shot: Shot, keyframe: Keyframe, wide: float) -> str:
    """Return how a field of view, rad, is written: by the key that the mission has, or by a new one."""
    drone, written = mission.drone(shot.drone), mission.origins.values
    angle, camera = f"{at_least(degrees(wide), 1)} deg", (*drone.path, "camera")
    if (*camera, "focal_length") in written:
        return f"shorten `focal_length` until the lens is {angle} wide"
    if (*keyframe.path, "hfov") in written or (*camera, "hfov") in written:
        return f"widen `hfov` to {angle}"
    return f"widen `hfov` to {angle}, by `camera: {{hfov: {angle}}}` of `{drone.name}`"


def _widest(mission: MissionIR, shot: Shot) -> float:
    """Return the widest field of view that the drone of a shot may have, rad."""
    lens = mission.drone(shot.drone).lens
    return WIDEST_RAD if lens is None else lens.widest


def does_not_fit(keyframe: Keyframe, setting: FixedCamera, requested: Vec2) -> Miss:
    """Return why no place of the set, nor of its vertical lines, is a candidate."""
    free = setting._replace(pitch=(-pi / 2, pi / 2))
    place = nearest_candidate(free, keyframe.composition, requested)
    place = place or nearest_on_verticals(free, keyframe.composition, requested)
    aim = None if place is None else free.aim(place)
    if aim is not None:
        return _beyond_gimbal(keyframe, setting, aim)
    if _no_angles(free, keyframe.composition):
        return _straight_over("G010", keyframe, setting)
    over = -roomiest(free, keyframe.composition)
    return Miss(
        "G010",
        keyframe,
        over,
        f"target `{keyframe.target}` does not fit into the frame",
        (
            f"wherever `{keyframe.composition.name}` puts it, at least {over:.2f} m are cropped, "
            f"{_range(setting)} and {degrees(setting.hfov):.1f} deg wide",
        ),
        partial(_what_fits_or_keep, keyframe, setting),
    )


def _no_angles(free: FixedCamera, composition: Composition) -> bool:
    """Return whether no angles put a target on any place of a set of points.

    That is so where the target is straight below or above: the camera does not roll, so such a target is on
    the picture's upright middle line.
    """
    aims = [free.aim(place) for place in (*composition.points, *composition.last)]
    lines = composition.u_lines or composition.v_lines
    return not lines and not any(aim is not None and reaches(free.pitch, aim[1]) for aim in aims)


def _straight_over(code: str, keyframe: Keyframe, setting: FixedCamera, *instead: str) -> Miss:
    """Return the report on a place that no angles reach, since the target is straight below or above."""
    name, side = keyframe.composition.name, "below" if setting.offset[2] < 0.0 else "above"
    half = "lower" if side == "below" else "upper"
    note = f"it is straight {side} the camera: it is on the frame's upright middle line, in the {half} half"
    return Miss(
        code,
        keyframe,
        hypot(*setting.offset),
        f"no angles of the camera put target `{keyframe.target}` on `{name}`",
        (note, *instead),
        lambda mission, _: f"{_to_center(keyframe, mission)}, or film the target from a place aside of it",
    )


def _to_center(keyframe: Keyframe, mission: MissionIR) -> str:
    """Return how to ask for the middle of the screen, by the key that asks for another place."""
    own = (*keyframe.path, "frame") in mission.origins.values
    return "write `frame: center`" if own else "set `composition: center`"


def _beyond_gimbal(keyframe: Keyframe, setting: FixedCamera, aim: Vec2) -> Miss:
    return Miss(
        "G013",
        keyframe,
        _excess(setting, aim[1]),
        f"the gimbal cannot pitch to frame target `{keyframe.target}`",
        (_reach(setting, aim[1]),),
        _within_reach(setting, aim[1]),
    )


def _excess(setting: FixedCamera, pitch: float) -> float:
    return max(setting.pitch[0] - pitch, pitch - setting.pitch[1])


def _reach(setting: FixedCamera, pitch: float) -> str:
    low, high = (degrees(p) for p in setting.pitch)
    needed = degrees(pitch)
    return f"the camera needs a pitch of {needed:.1f} deg; the gimbal reaches {low:.1f} to {high:.1f} deg"


def _within_reach(setting: FixedCamera, pitch: float) -> str:
    """Return how to bring a pitch into the gimbal's range, rounded away from the horizon."""
    above = pitch > setting.pitch[1]
    enough = (at_least if above else at_most)(degrees(pitch), 1)
    level = "higher" if above else "lower"
    return f"let the gimbal pitch to {enough} deg, or fly {level} or farther away"


def _what_fits_or_keep(keyframe: Keyframe, setting: FixedCamera, mission: MissionIR, shot: Shot) -> str:
    """Return what shows the whole target, or how to crop it on purpose."""
    whole = _what_fits(keyframe, setting, mission, shot)
    return f"{whole}, or {_to_keep(keyframe, mission)} to allow cropping"


def _what_fits(keyframe: Keyframe, setting: FixedCamera, mission: MissionIR, shot: Shot) -> str:
    """Return the least distance and field of view that show the whole target on the set, or beside it."""
    composition = keyframe.composition

    def options(fits: Fits) -> str:
        wide, widest = None, _widest(mission, shot)
        if setting.hfov < widest:
            wide = least(lambda a: fits(setting._replace(hfov=a)), setting.hfov, widest)
        distance = farther(mission, shot, keyframe, setting, fits)
        lens = "" if wide is None else _lens(mission, shot, keyframe, wide)
        return ", or ".join(option for option in (distance, lens) if option)

    return (
        options(lambda s: has_candidate(s, composition))
        or options(lambda s: roomiest(s, composition) >= -TOUCH_M)
        or "point the camera from lower or farther away, or make the target smaller"
    )


def _range(setting: FixedCamera) -> str:
    return f"seen from {hypot(*setting.offset):.1f} m"


def report(mission: MissionIR, shot: Shot, unmet: Iterable[Unmet]) -> list[Diagnostic]:
    """Return a shot's misses as diagnostics, one per cause and line of the mission.

    A line with an error gets no warnings, because its remedy changes them.
    """
    misses = [missed(keyframe) for keyframe in unmet]
    wrong = {miss.keyframe.path for miss in misses if miss.code not in _WARNINGS}
    groups: dict[tuple[KeyPath, str, str], list[Miss]] = {}
    for miss in misses:
        if miss.code in _WARNINGS and miss.keyframe.path in wrong:
            continue
        groups.setdefault((miss.keyframe.path, miss.code, miss.message), []).append(miss)
    return [_diagnostic(mission, shot, group) for group in groups.values()]


def _diagnostic(mission: MissionIR, shot: Shot, group: list[Miss]) -> Diagnostic:
    worst = max(group, key=lambda m: m.weight)
    notes = worst.notes
    if worst.keyframe.path[-1:] in (("kind",), ("file",)):
        place = ", ".join(f"{c:.1f}" for c in worst.keyframe.at)
        count = f"at {len(group)} of the {len(shot.keyframes)} keyframes of this {shot.kind}"
        notes = (*notes, f"{count}, this one at [{place}]")
    help_ = worst.help if isinstance(worst.help, str) else worst.help(mission, shot)
    label = parameter_label(mission, shot, worst.keyframe) or framing_label(mission, worst.keyframe)
    return Diagnostic(worst.code, worst.message, (label,), notes, help_)


def while_following(
    mission: MissionIR, keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> list[Diagnostic]:
    """Return errors for stated turns during which the camera would lose the target that it follows."""
    diagnostics = []
    for i, after in enumerate(placed):
        before = placed[i - 1]
        if after.turn is None or before.reference is None or after.reference is None:
            continue
        follows = wrapped(after.yaw - before.yaw)
        if abs(after.turn - follows) > pi:
            diagnostics.append(_lost(mission, keyframes[i], after, follows))
    return diagnostics


def _lost(mission: MissionIR, keyframe: Keyframe, placed: PlacedKeyframe, follows: float) -> Diagnostic:
    assert placed.turn is not None
    assert keyframe.heading is not None
    path = (*keyframe.path, "heading")
    direction = degrees(keyframe.heading % TURN_RAD)
    return Diagnostic(
        "K013",
        f"the camera cannot turn by {degrees(abs(placed.turn)):.0f} deg and follow target `{placed.target}`",
        (mission.origins.value(path),),
        (f"following it from the keyframe before takes {degrees(abs(follows)):.0f} deg",),
        f"write `heading: {direction:.0f} deg`, or turn between keyframes without a target",
    )
