"""Display: a fleet draws pictures in the air."""

from collections.abc import Iterator
from math import inf
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field
from pydantic.json_schema import JsonSchemaValue

from shotc.diag.model import Diagnostic
from shotc.ir.limits import Timing
from shotc.ir.show import Display, Picture, group_name
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.kinds.effect_stack import effects_of
from shotc.kinds.effects import MOST_EFFECTS, DisplayEffectSpec
from shotc.kinds.pictures import FilesSpec, FlightSpec, Frames, PictureSpec
from shotc.kinds.pyro import MOST_CUES, PyroSpec, cues_of
from shotc.kinds.sources import picture_of
from shotc.spec.fields import Name, Position
from shotc.spec.fieldtypes import FieldType
from shotc.spec.model import OneOf
from shotc.spec.pydantic_faults import fault
from shotc.spec.shot import NO_DRONE, ShotBase
from shotc.spec.words import nearest
from shotc.units import clip, describe

BALANCED_WEIGHT = 0.5  # between the best picture from the viewpoint and the best volume
OF_CAMERAS = ("target", "composition", "size", "require", "refine", "allow")


class WeightType(FieldType):
    """A number from 0 to infinity; infinity is written `.inf`."""

    label = "ViewpointWeight"

    def read(self, value: Any) -> float:
        """Return the number. Raise a fault unless it is 0 or more."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            help_ = "write 0 for the best picture from the viewpoint, .inf for the best volume"
            raise fault("wrong-type", f"expected a number, got {describe(value)}", help_)
        if not value >= 0:
            raise fault("out-of-range", f"`{clip(str(value))}` is below 0", "give 0 or more, or .inf")
        return float(value)

    def schema(self) -> JsonSchemaValue:
        """Return a number schema."""
        return {"type": "number", "minimum": 0}


class DisplayShot(ShotBase):
    """The parameters of a display; it has a fleet instead of a drone."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("fleet",), ("drone",)), required=False),)

    kind: Literal["display"] = Field(description="what sort of shot it is")
    drone: Name = Field(default=NO_DRONE, description="not for a display: it has a fleet")
    fleet: Name = Field(description="name of the fleet that draws")
    group: Name | None = Field(default=None, description="name of the group of that fleet that draws alone")
    frames: Frames = Field(
        description="what it draws: pictures in order, the files of an animation, or a recorded flight"
    )
    viewpoint: Position | None = Field(default=None, description="where the audience is")
    viewpoint_weight: Annotated[float, WeightType()] | None = Field(
        default=None,
        description="0 for the best picture from the viewpoint, .inf for the best volume; 0.5 by default",
    )
    pyro: tuple[PyroSpec, ...] = Field(
        default=(), max_length=MOST_CUES, description="products that burn on its drones, and when"
    )
    effects: tuple[DisplayEffectSpec, ...] = Field(
        default=(), max_length=MOST_EFFECTS, description="effects on all its lights, over those of its frames"
    )


def expand(shot: DisplayShot, scene: Scene) -> Expansion:
    """Return the display, or the faults of its text; the content of its files is checked later."""
    frames = shot.frames
    written: tuple[FilesSpec | FlightSpec | PictureSpec, ...]
    written = (frames,) if isinstance(frames, FilesSpec | FlightSpec) else frames
    pictures = [picture_of(spec, scene, i) for i, spec in enumerate(written)]
    burning = cues_of(shot.pyro, scene)
    wrong = [fault for picture in pictures if isinstance(picture, list) for fault in picture]
    wrong = [*wrong, *burning.faults]
    effects = effects_of(shot.effects, scene, (*scene.path, "effects"), len(pictures))
    faults = [*_unknown_fleet(shot, scene), *_useless(shot, scene), *_twice(shot, scene), *wrong]
    if faults or isinstance(effects, list):
        return Expansion.of([*faults, *(effects if isinstance(effects, list) else ())])
    display = _display(shot, scene, tuple(p for p in pictures if isinstance(p, Picture)))
    return Expansion(display=display._replace(pyro=burning.cues, effects=effects))


def _display(shot: DisplayShot, scene: Scene, pictures: tuple[Picture, ...]) -> Display:
    weight = BALANCED_WEIGHT if shot.viewpoint_weight is None else shot.viewpoint_weight
    return Display(
        id=shot.id,
        fleet=group_name(shot.fleet, shot.group),
        pictures=pictures,
        viewpoint=None if shot.viewpoint is None else scene.place(shot.viewpoint),
        weight=inf if shot.viewpoint is None else weight,
        timing=Timing(shot.timing.start, shot.timing.after),
        pace=shot.pace or scene.pace,
        path=scene.path,
    )


def _unknown_fleet(shot: DisplayShot, scene: Scene) -> Iterator[Diagnostic]:
    if shot.fleet in scene.fleets:
        yield from _unknown_group(shot, scene)
        return
    help_ = nearest(shot.fleet, dict.fromkeys(scene.fleets)) if scene.fleets else "define it under `fleets`"
    label = scene.origins.value((*scene.path, "fleet"))
    yield Diagnostic("N003", f"unknown fleet `{shot.fleet}`", (label,), help=help_)


def _unknown_group(shot: DisplayShot, scene: Scene) -> Iterator[Diagnostic]:
    known = scene.fleets[shot.fleet]
    if shot.group is None or shot.group in known:
        return
    help_ = (
        nearest(shot.group, known)
        if known
        else f"give it drones, as `groups: {{{shot.group}: 1-20}}` of the fleet"
    )
    label = scene.origins.value((*scene.path, "group"))
    yield Diagnostic("N020", f"fleet `{shot.fleet}` has no group `{shot.group}`", (label,), help=help_)


def _useless(shot: DisplayShot, scene: Scene) -> Iterator[Diagnostic]:
    """Yield faults of keys without meaning in a display: those of cameras, and those that its pictures
    replace.
    """
    for key in OF_CAMERAS:
        if key in shot.model_fields_set:
            yield _no_such(scene, key, "it is for what a camera films", f"remove `{key}`", key)
    if shot.timing.duration is not None:
        note = "its pictures' `transition` and `hold` say how long it lasts"
        yield _no_such(scene, "duration", note, "remove it, and give those times", "timing", "duration")
    if shot.viewpoint_weight is not None and shot.viewpoint is None:
        note = "it weighs the picture from a viewpoint, and the display has none"
        yield _no_such(scene, "viewpoint_weight", note, "add `viewpoint`, or remove it", "viewpoint_weight")


def _twice(shot: DisplayShot, scene: Scene) -> Iterator[Diagnostic]:
    """Yield the fault of a start that both the timing and the first picture give."""
    frames = shot.frames
    if shot.timing.start is None or isinstance(frames, FilesSpec | FlightSpec) or frames[0].at is None:
        return
    labels = (
        scene.origins.value((*scene.path, "timing", "start")),
        scene.origins.value((*scene.path, "frames", 0, "at"), "and here"),
    )
    note = "a display starts when its first picture stands"
    yield Diagnostic(
        "D125",
        "the start of this display is said twice",
        labels,
        (note,),
        "remove it, or `at` of the picture",
    )


def _no_such(scene: Scene, key: str, note: str, help: str, *path: str) -> Diagnostic:
    label = scene.origins.key((*scene.path, *path))
    return Diagnostic("D008", f"this display has no use for `{key}`", (label,), (note,), help)


KIND = Kind("display", "let a fleet draw pictures in the air", DisplayShot, expand)
