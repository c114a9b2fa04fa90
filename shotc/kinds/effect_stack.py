"""Lowering of a display's effects to MissionIR: times as pictures or seconds, positions in W."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from shotc.diag.model import Diagnostic
from shotc.ir.effects import (
    LIGHT_RATE_HZ,
    SHORTEST_PASS_S,
    Chase,
    DisplayTime,
    Effect,
    Fade,
    Image,
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
from shotc.kinds.moments import on_beat
from shotc.rounding import at_least

IMAGES = (".png", ".gif")


def effects_of(
    specs: Sequence[EffectSpec], scene: Scene, path: KeyPath, pictures: int = 0
) -> tuple[Effect, ...] | list[Diagnostic]:
    """Return a stack of effects, or all its faults.

    path : of the stack in the mission; pictures : their number in the display, for a stack over all of them
    """
    effects: list[Effect] = []
    faults: list[Diagnostic] = []
    for i, spec in enumerate(specs):
        where = (*path, i)
        faults += _faults(spec, scene, where)
        span = _span(spec, scene, where, pictures) if isinstance(spec, DisplayEffectSpec) else (None, None)
        if isinstance(span, list):
            faults += span
            continue
        over = spec.over if isinstance(spec, FrameEffectSpec) else "display"
        paint = _paint(spec, scene)
        effects.append(
            Effect(paint, spec.blend, spec.opacity, spec.fade_in, spec.fade_out, over, *span, where)
        )
    return faults or tuple(effects)


def _paint(spec: EffectSpec, scene: Scene) -> Paint:
    """Return the paint of an effect; its model ensures that there is exactly one."""
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


def _faults(spec: EffectSpec, scene: Scene, path: KeyPath) -> Iterator[Diagnostic]:
    if spec.ramp is not None:
        yield from _of_ramp(spec.ramp, scene, (*path, "ramp"))
    if spec.chase is not None:
        yield from _of_chase(spec.chase, scene, (*path, "chase"))
    if spec.image is not None:
        yield from _of_image(spec.image, scene, (*path, "image"))


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
    passage = spec.period * spec.length
    if passage >= SHORTEST_PASS_S - 1e-9:
        return
    slower, longer = at_least(SHORTEST_PASS_S / spec.length), at_least(SHORTEST_PASS_S / spec.period)
    note = f"lights change {LIGHT_RATE_HZ:g} times a second, so {1e3 * SHORTEST_PASS_S:.0f} ms is the least"
    help_ = f"write `period: {slower} s`"
    if float(longer) <= 1.0:
        help_ += f", or `length: {longer}`"
    message = f"the band of this chase passes a light in {1e3 * passage:.0f} ms"
    yield Diagnostic("D096", message, (scene.origins.value((*path, "period")),), (note,), help_)


def _of_image(spec: ImageSpec, scene: Scene, path: KeyPath) -> Iterator[Diagnostic]:
    if not spec.file.lower().endswith(IMAGES):
        message = f"`{spec.file}` is in no format that an image is read from"
        help_ = f"give a file that ends in {' or '.join(IMAGES)}"
        yield Diagnostic("D011", message, (scene.origins.value((*path, "file")),), help=help_)


def _span(
    spec: DisplayEffectSpec, scene: Scene, path: KeyPath, pictures: int
) -> tuple[DisplayTime | None, DisplayTime | None] | list[Diagnostic]:
    """Return the start and end of an effect, None where not given, or all faults."""
    written = (("from", spec.from_), ("until", spec.until))
    marks = [_mark(mark, scene, (*path, key), pictures) for key, mark in written]
    faults = [mark for mark in marks if isinstance(mark, Diagnostic)]
    faults += _backwards(spec.from_, spec.until, scene, (*path, "until"))
    start, end = (mark if isinstance(mark, DisplayTime) else None for mark in marks)
    return faults or (start, end)


def _mark(
    spec: MarkSpec | None, scene: Scene, path: KeyPath, pictures: int
) -> DisplayTime | Diagnostic | None:
    """Return a time, or its fault; None if it is not given or its beats are unusable."""
    if spec is None:
        return None
    if spec.beat is not None or spec.bar is not None:
        time = on_beat(spec.beat, spec.bar, scene, path)
        return DisplayTime(None, None, time) if isinstance(time, float) else time
    if spec.frame is None:
        return DisplayTime(spec.seconds, None)
    if spec.frame <= pictures:
        return DisplayTime(None, spec.frame - 1)
    message = f"there is no frame {spec.frame}: the display has {pictures}"
    help_ = f"write `{path[-1]}: {{frame: {pictures}}}`, or an earlier frame"
    return Diagnostic("D097", message, (scene.origins.value(path),), help=help_)


def _backwards(
    start: MarkSpec | None, end: MarkSpec | None, scene: Scene, path: KeyPath
) -> Iterator[Diagnostic]:
    """Yield the fault of an effect that ends before it starts; path : of its end."""
    if start is None or end is None:
        return
    label = scene.origins.value(path)
    if start.seconds is not None and end.seconds is not None and end.seconds <= start.seconds:
        message = f"the effect ends at {end.seconds:g} s, but begins at {start.seconds:g} s"
        yield Diagnostic("D098", message, (label,), help=f"write `until: {start.seconds + 1:g} s`, or later")
    elif start.frame is not None and end.frame is not None and end.frame < start.frame:
        message = f"the effect ends with frame {end.frame}, but begins with frame {start.frame}"
        help_ = f"write `until: {{frame: {start.frame}}}`, or a later frame"
        yield Diagnostic("D098", message, (label,), help=help_)
