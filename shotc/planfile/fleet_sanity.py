"""Checks of the fleets in a plan file beyond their types; ``planfile.sanity`` checks the rest."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite

import numpy as np

from shotc.ir.fleet import FleetTrajectory
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, FleetGroup, Model, Picture, group_name
from shotc.ir.trajectory import TrajectoryIR
from shotc.planfile.light_sanity import light_faults

MOST_FLEET_TICKS = 50_000_000
"""Most ticks of the output clock of all drones of a fleet together."""

MOST_DRONES = 100_000
"""Most drones of a fleet."""

Fault = tuple[str, str]


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
