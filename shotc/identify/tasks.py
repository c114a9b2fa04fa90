"""The keyframes whose targets are identified, and the diagnostics of those without a result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot, pi
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.geom.camera import ScreenBox
from shotc.identify.choice import Choice
from shotc.identify.cylinders import Upright
from shotc.identify.find import Glance, SearchResult, held
from shotc.identify.views import CameraPose
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.planning.framing.placing import explicit_aim

DOUBTFUL_SHARE = 0.6
"""Share of a box's content, below which a target is doubtful."""


class SearchTask(NamedTuple):
    """A keyframe whose target is sought.

    number : of the keyframe in its shot
    guessed : whether the box is a guess
    """

    shot: str
    number: int
    keyframe: Keyframe
    camera: CameraPose
    box: ScreenBox | None
    guessed: bool = False

    @property
    def glance(self) -> Glance:
        """Its camera and its box, which it must have."""
        assert self.box is not None
        return Glance(self.camera, self.box)

    @property
    def label(self) -> str:
        """Its name in the summary and on the sheet."""
        return f"{self.shot}, keyframe {self.number + 1}"


def tasks(mission: MissionIR, *, guess: bool) -> tuple[SearchTask, ...]:
    """Return the keyframes whose target is sought.

    guess : whether to include keyframes without a box
    """
    searches = []
    for shot in mission.shots:
        for number, keyframe in enumerate(shot.keyframes):
            written = keyframe.path[-2:] == ("keyframes", number)
            if written and (keyframe.unidentified or (guess and keyframe.target is None)):
                box = None if keyframe.box is None else ScreenBox(*keyframe.box)
                searches.append(
                    SearchTask(shot.id, number, keyframe, _camera(mission, shot, keyframe), box, box is None)
                )
    return tuple(searches)


def _camera(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> CameraPose:
    assert keyframe.aim is not None, "what looks at a target has one"
    yaw, pitch = explicit_aim(keyframe.at, keyframe.aim, pi / 2)
    return CameraPose(keyframe.at, yaw, pitch, keyframe.hfov, mission.drone(shot.drone).aspect)


def nothing_to_do(mission: MissionIR, searches: Sequence[SearchTask]) -> Diagnostic | None:
    """Return the reason why no target can be sought, or None."""
    if not searches:
        boxed = any(k.box is not None for shot in mission.shots for k in shot.keyframes)
        lacks = "every box has its target" if boxed else "no keyframe has a `box`"
        return Diagnostic(
            "N017",
            f"nothing is left to identify: {lacks}",
            (mission.origins.key(("shots",)),),
            help="draw `box: [u0, v0, u1, v1]` in a keyframe without a target, or add `--guess`",
        )
    if mission.meshes:
        return None
    return Diagnostic(
        "N017",
        "the mission has no scene in which a target could be found",
        (_box_label(mission, searches[0]),),
        help="name a mesh or a cloud as `world: {scene: {file: ...}}`, or footprints as `buildings`",
    )


def unguessed(mission: MissionIR, task: SearchTask) -> Diagnostic:
    """Return the fault that a keyframe's picture gives no guess."""
    label = mission.origins.value((*task.keyframe.path, "at"))
    return Diagnostic(
        "N018",
        "nothing in the picture of the keyframe stands out",
        (label,),
        help="draw `box: [u0, v0, u1, v1]` round what is meant",
    )


def empty(mission: MissionIR, result: SearchResult, searches: Sequence[SearchTask]) -> list[Diagnostic]:
    """Return the faults on boxes without a possible target."""
    return [
        _empty(mission, result, number, task)
        for number, task in enumerate(searches)
        if result.choices[number] is None
    ]


def _empty(mission: MissionIR, result: SearchResult, number: int, task: SearchTask) -> Diagnostic:
    share = held(result.clustered.seen[number])
    what = "only the sky" if share.sky == 1.0 else "only ground" if share.ground == 1.0 else ""
    if not what and share.scene == 0.0:
        what = "only sky and ground"
    points = ", ".join(f"{100 * part:.0f} % {name}" for name, part in share._asdict().items())
    return Diagnostic(
        "N018",
        f"the box holds {what}" if what else "the box holds too little of the scene to be a target",
        (_box_label(mission, task),),
        (f"its rays meet: {points}", "what is less than 0.5 m above the ground counts as ground"),
        "draw it round what is meant: [u0, v0, u1, v1], u to the right and v up, from -1 to 1",
    )


def _box_label(mission: MissionIR, task: SearchTask) -> Label:
    return mission.origins.value((*task.keyframe.path, "at" if task.guessed else "box"))


def swallowed(mission: MissionIR, result: SearchResult, searches: Sequence[SearchTask]) -> list[Diagnostic]:
    """Return the faults on cameras inside the cylinder around their own target."""
    faults = []
    for target in result.targets:
        for number in target.glances:
            if not _holds(target.cylinder, searches[number].camera):
                continue
            c = target.cylinder
            x, y = c.centre
            where = f"radius {c.radius:.1f} m about [{x:.1f}, {y:.1f}], up to z = {c.top:.1f} m"
            faults.append(
                Diagnostic(
                    "N018",
                    "the camera stands inside of the cylinder about what its box holds",
                    (_box_label(mission, searches[number]),),
                    (f"the cylinder: {where}", "a target is a cylinder, and kept clear of"),
                    "draw the box round a part that the camera is outside of, or move the keyframe",
                )
            )
    return faults


def _holds(c: Upright, camera: CameraPose) -> bool:
    x, y, z = camera.eye
    return hypot(x - c.centre[0], y - c.centre[1]) < c.radius and c.bottom < z < c.top


def doubts(
    mission: MissionIR, result: SearchResult, searches: Sequence[SearchTask], names: Sequence[str]
) -> Iterator[Diagnostic]:
    """Yield warnings on targets with a small share of their box.

    names : of the targets
    """
    called = {target.cluster: name for target, name in zip(result.targets, names, strict=True)}
    for number, task in enumerate(searches):
        choice = result.choices[number]
        if choice is None or choice.share >= DOUBTFUL_SHARE:
            continue
        yield Diagnostic(
            "N019",
            f"`{called[choice.cluster]}` is {100 * choice.share:.0f} % of what the box means",
            (_box_label(mission, task),),
            tuple(_runner_up(result, choice, called)),
            "look at the sheet; draw the box closer round what is meant, and identify again",
        )


def _runner_up(result: SearchResult, choice: Choice, called: dict[int, str]) -> Iterator[str]:
    if choice.runner_up is None:
        return
    points, cluster = result.clustered.points, result.clustered.cluster
    x, y, _ = points.point[cluster == choice.runner_up].mean(axis=0)
    name = called.get(choice.runner_up)
    what = f"`{name}`" if name else "what stands"
    yield f"next is {what} about [{x:.1f}, {y:.1f}]"
