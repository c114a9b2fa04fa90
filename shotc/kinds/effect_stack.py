"""The effects of a display made records of MissionIR: moments as pictures or seconds, places put into W."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from shotc.diag.model import Diagnostic
from shotc.ir.effects import (
    LEAST_PASS,
    LIGHT_RATE,
    Chase,
    Effect,
    Fade,
    Image,
    Mark,
    Paint,
    Ramp,
    Sparkle,
)
from shotc.ir.limits import Vec3
from shotc.ir.origin import KeyPath
from shotc.kinds.base import Place, Scene
from shotc.kinds.effects import (
    ChaseSpec,
    DisplayEffectSpec,
    EffectSpec,
    FrameEffectSpec,
    ImageSpec,
    MarkSpec,
    RampSpec,
)
from shotc.kinds.moments import moment
from shotc.rounding import at_least
from shotc.spec.music import MomentSpec

IMAGES = (".png", ".gif")


def effects_of(
    specs: Sequence[EffectSpec], scene: Scene, path: KeyPath, pictures: int = 0
) -> tuple[Effect, ...] | list[Diagnostic]:
    """Return a stack, or all that is wrong with it.

    path : of the stack in the mission; pictures : of its display, for one that lies over all of them
    """
    found: list[Effect] = []
    faults: list[Diagnostic] = []
    for i, spec in enumerate(specs):
        where = (*path, i)
        faults += _faults(spec, scene, where, pictures)
        found.append(_effect(spec, scene, where))
    return faults or tuple(found)


def _effect(spec: EffectSpec, scene: Scene, path: KeyPath) -> Effect:
    over = spec.over if isinstance(spec, FrameEffectSpec) else "display"
    since, until = None, None
    if isinstance(spec, DisplayEffectSpec):
        since, until = (
            _mark(mark, scene, (*path, key)) for key, mark in (("from", spec.from_), ("until", spec.until))
        )
    paint = _paint(spec, scene)
    return Effect(paint, spec.blend, spec.opacity, spec.fade_in, spec.fade_out, over, since, until, path)


def _paint(spec: EffectSpec, scene: Scene) -> Paint:
    """Return what an effect paints; its model has made sure that it is one thing."""
    if spec.fade is not None:
        color = spec.fade.from_ if spec.fade.to is None else spec.fade.to
        assert color is not None
        return Fade(color, spec.fade.to is not None, spec.fade.time)
    if spec.ramp is not None:
        ramp = spec.ramp
        count = len(ramp.colors)
        at = ramp.at or tuple(i / (count - 1) for i in range(count))
        along = None if ramp.along == "time" else ramp.along
        return Ramp(ramp.colors, at, along, _center(ramp.center, scene), ramp.period)
    if spec.chase is not None:
        chase = spec.chase
        return Chase(chase.color, chase.along, _center(chase.center, scene), chase.period, chase.length)
    if spec.sparkle is not None:
        return Sparkle(spec.sparkle.color, spec.sparkle.share, spec.sparkle.period)
    assert spec.image is not None
    return Image(spec.image.file, spec.image.fit, spec.image.period)


def _center(place: Place | None, scene: Scene) -> Vec3 | None:
    return None if place is None else scene.place(place)


def _mark(spec: MarkSpec | None, scene: Scene, path: KeyPath) -> Mark | None:
    """Return a moment; one on a beat that is not known is told by ``_of_marks`` and is none here."""
    if spec is None:
        return None
    if spec.beat is not None or spec.bar is not None:
        time = moment(_on_beat(spec), scene, path)
        return Mark(None, None, time) if isinstance(time, float) else None
    return Mark(spec.seconds, None if spec.frame is None else spec.frame - 1)


def _on_beat(spec: MarkSpec) -> MomentSpec:
    return MomentSpec.model_construct(time=None, beat=spec.beat, bar=spec.bar)


def _faults(spec: EffectSpec, scene: Scene, path: KeyPath, pictures: int) -> Iterator[Diagnostic]:
    if spec.ramp is not None:
        yield from _of_ramp(spec.ramp, scene, (*path, "ramp"))
    if spec.chase is not None:
        yield from _of_chase(spec.chase, scene, (*path, "chase"))
    if spec.image is not None:
        yield from _of_image(spec.image, scene, (*path, "image"))
    if isinstance(spec, DisplayEffectSpec):
        yield from _of_marks(spec, scene, path, pictures)


def _of_ramp(spec: RampSpec, scene: Scene, path: KeyPath) -> Iterator[Diagnostic]:
    if spec.at is None:
        return
    label = scene.origins.value((*path, "at"))
    if len(spec.at) != len(spec.colors):
        message = f"a ramp of {len(spec.colors)} colours has {len(spec.at)} places"
        help_ = f"give {len(spec.colors)} places, or leave `at` out to spread the colours evenly"
        yield Diagnostic("D095", message, (label,), help=help_)
        return
    back = next(((one, other) for one, other in pairwise(spec.at) if other < one), None)
    if back is not None:
        ordered = ", ".join(f"{place:g}" for place in sorted(spec.at))
        message = f"the places of a ramp's colours go back, from {back[0]:g} to {back[1]:g}"
        yield Diagnostic("D095", message, (label,), help=f"write them in order: `at: [{ordered}]`")


def _of_chase(spec: ChaseSpec, scene: Scene, path: KeyPath) -> Iterator[Diagnostic]:
    lasts = spec.period * spec.length
    if lasts >= LEAST_PASS - 1e-9:
        return
    slower, longer = at_least(LEAST_PASS / spec.length), at_least(LEAST_PASS / spec.period)
    note = f"lights change {LIGHT_RATE:g} times a second, so {1e3 * LEAST_PASS:.0f} ms is the least"
    help_ = f"write `period: {slower} s`"
    if float(longer) <= 1.0:
        help_ += f", or `length: {longer}`"
    message = f"the band of this chase passes a light in {1e3 * lasts:.0f} ms"
    yield Diagnostic("D096", message, (scene.origins.value((*path, "period")),), (note,), help_)


def _of_image(spec: ImageSpec, scene: Scene, path: KeyPath) -> Iterator[Diagnostic]:
    if not spec.file.lower().endswith(IMAGES):
        message = f"`{spec.file}` is in no format that an image is read from"
        help_ = f"give a file that ends in {' or '.join(IMAGES)}"
        yield Diagnostic("D011", message, (scene.origins.value((*path, "file")),), help=help_)


def _of_marks(spec: DisplayEffectSpec, scene: Scene, path: KeyPath, pictures: int) -> Iterator[Diagnostic]:
    for key, mark in (("from", spec.from_), ("until", spec.until)):
        if mark is not None and (mark.beat is not None or mark.bar is not None):
            time = moment(_on_beat(mark), scene, (*path, key))
            if isinstance(time, Diagnostic):
                yield time
        if mark is not None and mark.frame is not None and mark.frame > pictures:
            label = scene.origins.value((*path, key))
            message = f"there is no frame {mark.frame}: the display has {pictures}"
            yield Diagnostic(
                "D097", message, (label,), help=f"write `{key}: {{frame: {pictures}}}`, or an earlier frame"
            )
    since, until = spec.from_, spec.until
    if since is None or until is None:
        return
    label = scene.origins.value((*path, "until"))
    if since.seconds is not None and until.seconds is not None and until.seconds <= since.seconds:
        message = f"the effect ends at {until.seconds:g} s, but begins at {since.seconds:g} s"
        yield Diagnostic("D098", message, (label,), help=f"write `until: {since.seconds + 1:g} s`, or later")
    elif since.frame is not None and until.frame is not None and until.frame < since.frame:
        message = f"the effect ends with frame {until.frame}, but begins with frame {since.frame}"
        help_ = f"write `until: {{frame: {since.frame}}}`, or a later frame"
        yield Diagnostic("D098", message, (label,), help=help_)
