"""Checks of fleets and their lights in a plan file beyond types; ``planfile.sanity`` checks the rest."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite

import numpy as np

from shotc.ir.fleet import FleetTrajectory, Lights
from shotc.ir.light_layers import Axis, Band, Footage, Glints, Gradient, Layer, Radius, Tint
from shotc.ir.light_paints import pixels
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, FleetGroup, Model, Picture, group_name
from shotc.ir.trajectory import TrajectoryIR

MOST_FLEET_TICKS = 50_000_000
"""Most ticks of the output clock of all drones of a fleet together."""

MOST_DRONES = 100_000
"""Most drones of a fleet."""

Fault = tuple[str, str]
MOST_PIXELS = 16_000_000
"""Most pixels of all frames of an image together."""


def fleet_faults(ir: TrajectoryIR) -> Iterator[Fault]:
    """Yield (path, fault) for everything that makes a proof of the fleets meaningless."""
    mission = ir.keyframes.mission
    for i, fleet in enumerate(mission.fleets):
        yield from _fleet(fleet, f"mission.fleets[{i}]")
    drones = {fleet.name: set(fleet.numbers) for fleet in mission.fleets}
    targets = {target.name for target in mission.every_target}
    for i, display in enumerate(mission.displays):
        if display.fleet not in drones:
            yield f"mission.displays[{i}].fleet", f"there is no fleet `{display.fleet}`"
        for k, cue in enumerate(display.pyro):
            if not drones.get(display.fleet, set()).issuperset(cue.drones):
                yield f"mission.displays[{i}].pyro[{k}].drones", f"not all are drones of `{display.fleet}`"
        yield from _display(display, f"mission.displays[{i}]")
        for k, picture in enumerate(display.pictures):
            if picture.name is not None and picture.name not in targets:
                yield f"mission.displays[{i}].pictures[{k}].name", f"there is no target `{picture.name}`"
    for i, track in enumerate(ir.fleets):
        yield from _track(track, mission, f"fleets[{i}]")


def _fleet(fleet: Fleet, path: str) -> Iterator[Fault]:
    positive = {
        **{f"limits.{name}": value for name, value in fleet.limits.bounds.items()},
        "endurance": fleet.endurance,
        "apart.horizontal": fleet.apart.horizontal,
        "apart.vertical": fleet.apart.vertical,
    }
    for name, value in positive.items():
        if value <= 0:
            yield f"{path}.{name}", f"{value:g} is not positive"
    for name, value in (("radius", fleet.radius), ("rise", fleet.rise), ("apart.margin", fleet.apart.margin)):
        if value < 0:
            yield f"{path}.{name}", f"{value:g} is negative"
    if not 0 < len(fleet.pads) <= MOST_DRONES:
        yield f"{path}.pads", f"there are {len(fleet.pads)}, 1 to {MOST_DRONES} are possible"
    if fleet.group is not None:
        yield from _group(fleet, fleet.group, f"{path}.group")


def _group(fleet: Fleet, group: FleetGroup, path: str) -> Iterator[Fault]:
    if fleet.name != group_name(group.of, group.name or None):
        yield f"{path}.name", f"the group is called `{group.name}`, and the fleet `{fleet.name}`"
    rising = all(a < b for a, b in pairwise((0, *group.numbers, group.total + 1)))
    if len(group.numbers) != len(fleet.pads) or not rising:
        yield f"{path}.numbers", f"they are not {len(fleet.pads)} numbers that rise from 1 to {group.total}"


def _display(display: Display, path: str) -> Iterator[Fault]:
    if not display.pictures:
        yield f"{path}.pictures", "there is none"
    if display.weight < 0:
        yield f"{path}.weight", f"{display.weight:g} is negative"
    if not 0 < display.pace <= 1:
        yield f"{path}.pace", f"{display.pace:g} is not between 0 and 1"
    for i, picture in enumerate(display.pictures):
        yield from _picture(picture, f"{path}.pictures[{i}]")


def _picture(picture: Picture, path: str) -> Iterator[Fault]:
    if picture.hold < 0:
        yield f"{path}.hold", f"{picture.hold:g} is negative"
    if picture.transition is not None and picture.transition < 0:
        yield f"{path}.transition", f"{picture.transition:g} is negative"
    if picture.wave is not None and picture.wave.time <= 0:
        yield f"{path}.wave.time", f"{picture.wave.time:g} is not positive"
    if any(not 0 <= part <= 255 for part in picture.color or ()):
        yield f"{path}.color", "a part of it is not between 0 and 255"
    if isinstance(picture.source, Model) and not picture.source.files:
        yield f"{path}.source.files", "there is none"


def _track(track: FleetTrajectory, mission: MissionIR, path: str) -> Iterator[Fault]:
    fleet = next((f for f in mission.fleets if f.name == track.fleet), None)
    if fleet is None:
        yield f"{path}.fleet", f"there is no fleet `{track.fleet}`"
        return
    n, breaks = len(fleet.pads), track.breaks
    if len(breaks) < 2 or not (np.diff(breaks) > 0).all():
        yield f"{path}.breaks", "they do not rise"
        return
    if track.coef.shape != (n, len(breaks) + 2, 3):
        yield f"{path}.coef", f"is of shape {track.coef.shape}, not {(n, len(breaks) + 2, 3)}"
    if track.lights.colors.shape[:2] != (n, len(track.lights.times)):
        yield f"{path}.lights.colors", "does not have a colour for every drone and time"
    if (np.diff(track.lights.times) < 0).any():
        yield f"{path}.lights.times", "they do not rise"
    yield from light_faults(track.lights, f"{path}.lights")
    pictures = {d.id: len(d.pictures) for d in mission.displays if d.fleet == fleet.name}
    for i, frame in enumerate(track.shown):
        if not 0 <= frame.picture < pictures.get(frame.display, 0):
            yield f"{path}.shown[{i}]", f"there is no picture {frame.picture} of a display `{frame.display}`"
    end = max([float(breaks[-1]), *(p.end for p in track.phases), *(s.end for s in track.shown)])
    if not isfinite(end) or end * mission.rate * n > MOST_FLEET_TICKS:
        yield f"{path}.breaks", f"it lasts {end:g} s: too many samples at {mission.rate:g} Hz"


def light_faults(lights: Lights, path: str) -> Iterator[Fault]:
    """Yield (path, fault) for everything that prevents the evaluation of the effects."""
    if len(lights.of) != (len(lights.times) if lights.looks else 0):
        yield f"{path}.of", "does not say for every time which look holds"
    if any(not -1 <= look < len(lights.looks) for look in lights.of):
        yield f"{path}.of", "names a look that there is not"
    for i, look in enumerate(lights.looks):
        if any(not 0 <= drone < len(lights.colors) for drone in look.spare):
            yield f"{path}.looks[{i}].spare", "names a drone that there is not"
        for k, layer in enumerate(look.layers):
            yield from _layer(layer, f"{path}.looks[{i}].layers[{k}]")
    for k, layer in enumerate(lights.over):
        yield from _layer(layer, f"{path}.over[{k}]")


def _layer(layer: Layer, path: str) -> Iterator[Fault]:
    if not 0.0 <= layer.opacity <= 1.0:
        yield f"{path}.opacity", f"{layer.opacity:g} is not between 0 and 1"
    if isinstance(layer.paint, Footage):
        yield from _footage(layer.paint, f"{path}.paint")
    else:
        yield from _paint(layer.paint, f"{path}.paint")


def _paint(paint: Tint | Gradient | Band | Glints, path: str) -> Iterator[Fault]:
    colors = paint.colors if isinstance(paint, Gradient) else (paint.color,)
    if any(not 0 <= part <= 255 for color in colors for part in color):
        yield path, "a part of a colour is not between 0 and 255"
    if isinstance(paint, Gradient) and (
        not paint.at or len(paint.at) != len(paint.colors) or any(b < a for a, b in pairwise(paint.at))
    ):
        yield f"{path}.at", "does not rise, or does not have a place for every colour"
    if isinstance(paint, Glints) and paint.period <= 0:
        yield f"{path}.period", f"{paint.period:g} is not positive"
    if isinstance(paint, Glints) and not 0 <= paint.seed < 2**32:
        yield f"{path}.seed", "is not between 0 and 2^32"
    if isinstance(paint, Band) and not 0.0 < paint.length <= 1.0:
        yield f"{path}.length", f"{paint.length:g} is not between 0 and 1"
    along = paint.along if isinstance(paint, Band | Gradient) else None
    if isinstance(along, Axis) and not along.high > along.low:
        yield f"{path}.along", "has no length"
    if isinstance(along, Radius) and not along.reach > 0:
        yield f"{path}.along.reach", f"{along.reach:g} is not positive"


def _footage(paint: Footage, path: str) -> Iterator[Fault]:
    if not paint.ends or paint.ends[0] <= 0 or any(b < a for a, b in pairwise(paint.ends)):
        yield f"{path}.ends", "do not rise"
        return
    if min(paint.screen.width, paint.screen.height) <= 0:
        yield f"{path}.screen", "has no size"
    if min(paint.rows, paint.columns) <= 0 or paint.rows * paint.columns * len(paint.ends) > MOST_PIXELS:
        yield path, f"{len(paint.ends)} frames of {paint.columns} x {paint.rows} pixels are not read"
        return
    try:
        pixels(paint)
    except ValueError as fault:
        yield f"{path}.rgba", f"is no image: {fault}"
