"""References on screen for the subjects of shots on their own clock.

No one has framed these subjects, so the camera looks at them. The reference is the place of the composition
nearest to the middle at which the target is whole, half way through the shot.
"""

from __future__ import annotations

from math import degrees, hypot, pi

from shotc.diag.model import Diagnostic
from shotc.geom.shapes import POINT
from shotc.ir.begins import first_start
from shotc.ir.ideal import ideal_place
from shotc.ir.keyframes import PlacedSubject
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition, MissionIR, Shot, Subject
from shotc.passes.place_keyframes.farther import FARTHEST_RATIO, least
from shotc.passes.place_keyframes.faults import WIDEST_RAD
from shotc.planning.framing.candidates import TOUCH_M, FixedCamera, nearest_candidate, nearest_on_verticals
from shotc.rounding import at_least

MIDDLE = (0.0, 0.0)


def place_subjects(
    mission: MissionIR, shot: Shot
) -> tuple[tuple[PlacedSubject, ...], tuple[Diagnostic, ...]]:
    """Return each subject's reference on screen, and the diagnostics of infeasible compositions."""
    placed: list[PlacedSubject] = []
    diagnostics: list[Diagnostic] = []
    for subject in shot.subjects:
        reference, warnings = _reference(mission, shot, subject)
        placed.append(
            PlacedSubject(
                subject.target, reference, subject.size, subject.view, subject.path, subject.setpoints
            )
        )
        diagnostics += warnings
    return tuple(placed), tuple(diagnostics)


def _reference(mission: MissionIR, shot: Shot, subject: Subject) -> tuple[Vec2 | None, list[Diagnostic]]:
    composition = subject.composition
    if composition.watches:
        return None, []
    if composition.keep:
        return MIDDLE, []
    if shot.ideal is not None and shot.ideal.framed:
        # The reference is given, and the camera moves to where the subject has it.
        cropped = _cropped_at(mission, shot, subject) if len(shot.subjects) == 1 else None
        warnings = [] if cropped is None else [_cropped(mission, shot, subject, cropped, None)]
        return composition.points[0], warnings
    setting = setting_at(mission, shot, subject.target)
    if subject.size is not None and subject.size > 1.0:
        # A subject of this size is cropped on purpose, so only its centre is placed.
        setting = setting._replace(shape=POINT)
    place = nearest_candidate(setting, composition, MIDDLE)
    if place is not None:
        return place, []
    instead = nearest_on_verticals(setting, composition, MIDDLE)
    reference = _nearest_of_all(setting, composition)
    fault = _cropped(mission, shot, subject, reference, instead)
    return instead or reference, [
        fault._replace(help=_whole(mission, shot, setting, composition) or fault.help)
    ]


def _cropped_at(mission: MissionIR, shot: Shot, subject: Subject) -> Vec2 | None:
    """Return a reference at which the one subject of a framing is cropped; None where it is whole."""
    times = [setpoint.time for setpoint in subject.setpoints]
    for time in [0.0, *times] if times else [_half(shot)]:
        appearance = subject.asked(time)
        whole, place = appearance.size is None or appearance.size <= 1.0, appearance.place or MIDDLE
        if whole and setting_at(mission, shot, subject.target, time).slack(place) < -TOUCH_M:
            return place
    return None


def _half(shot: Shot) -> float:
    return 0.5 * (shot.timing.duration or 0.0)


def _whole(mission: MissionIR, shot: Shot, setting: FixedCamera, composition: Composition) -> str:
    """Return the lens that shows a whole target at a place of its composition; empty where none does."""

    def fits(hfov: float) -> bool:
        return nearest_candidate(setting._replace(hfov=hfov), composition, MIDDLE) is not None

    farther = _farther(mission, shot, setting, composition)
    wide = least(fits, setting.hfov, WIDEST_RAD) if setting.hfov < WIDEST_RAD else None
    if wide is None:
        return farther
    lens = at_least(degrees(wide), 1)
    drone = mission.drone(shot.drone)
    zooms = drone.zooms_unasked and drone.lens is not None and wide <= drone.lens.widest
    options = (
        "plan it with the refiner `ours`, which zooms there" if zooms else "",
        farther,
        f"film it through a lens of `camera: {{hfov: {lens} deg}}` of `{shot.drone}`",
    )
    return ", or ".join(option for option in options if option)


def _farther(mission: MissionIR, shot: Shot, setting: FixedCamera, composition: Composition) -> str:
    """Return the distance at which a whole target fits at a place of its composition; empty if none does.

    A distance that the mission writes is level; otherwise the camera goes straight back.
    """
    level = (*shot.path, "distance") in mission.origins.values
    x, y, z = setting.offset

    def fits(k: float) -> bool:
        back = setting._replace(offset=(x * k, y * k, z if level else z * k))
        return nearest_candidate(back, composition, MIDDLE) is not None

    k = least(fits, 1.0, FARTHEST_RATIO)
    if k is None:
        return ""
    if level and (*shot.path, "distance", 0) not in mission.origins.values:
        return f"write `distance: {at_least(k * hypot(x, y), 1)} m` or more"
    return f"film it from {at_least(k * hypot(x, y, z), 1)} m away or farther"


def setting_at(mission: MissionIR, shot: Shot, target: str, time: float | None = None) -> FixedCamera:
    """Return the camera at its ideal place and the target that it frames.

    time : of the shot, seconds; half way through it if None
    """
    start = first_start(mission, shot)
    t = start + (_half(shot) if time is None else time)
    drone, subject = mission.drone(shot.drone), mission.target(target)
    eye, centre = ideal_place(mission, shot, start, t), subject.at(t)
    x, y, z = (c - e for c, e in zip(centre, eye, strict=True))
    return FixedCamera((x, y, z), subject.shape_at(t), drone.hfov, drone.aspect, drone.gimbal.pitch, pi / 2)


def _nearest_of_all(setting: FixedCamera, composition: Composition) -> Vec2:
    points = [
        *composition.points,
        *((u, 0.0) for u in composition.u_lines),
        *((0.0, v) for v in composition.v_lines),
    ]
    return min(points, key=lambda p: setting.apart(p, MIDDLE))


def _cropped(
    mission: MissionIR, shot: Shot, subject: Subject, reference: Vec2, instead: Vec2 | None
) -> Diagnostic:
    label = mission.origins.value(subject.path)
    where = f"({reference[0]:.2f}, {reference[1]:.2f})"
    if shot.ideal is not None and shot.ideal.framed:
        note = "the camera goes where it has this place and its size, cropped as it is"
    elif instead is not None:
        note = f"it is filmed at ({instead[0]:.2f}, {instead[1]:.2f}) instead, where it is whole"
    else:
        note = "no place on screen shows it whole from there"
    return Diagnostic(
        "M007",
        f"target `{subject.target}` is cropped at {where} in shot `{shot.id}`",
        (label,),
        (note,),
        "film it from farther away, or with a wider field of view",
    )
