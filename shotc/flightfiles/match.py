"""Whose flight a file is: a drone's of the mission, by the file's name or by what the user says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePath
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.importers.flights.points import NOBODY
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.source.file import WHOLE_FILE

PART = re.compile(r"(?P<drone>.+?)(?:-(?P<part>[1-9][0-9]?))?(?:-litchi)?", re.IGNORECASE)


class Owned(NamedTuple):
    """The files of one drone, in the order in which they are flown: their places among all."""

    drone: Drone
    files: tuple[int, ...]


def owners(
    mission: MissionIR, names: Sequence[str], told: Sequence[str]
) -> tuple[tuple[Owned, ...], tuple[Diagnostic, ...]]:
    """Return the drones that have files, in the order of the mission, and what belongs to nobody.

    names : of the files; told : the drone of each, or of none
    A file is of the drone that it is named after: ``cam1.kmz``, ``cam1-litchi.csv``, or ``cam1-1.kmz`` and on
    for the parts of one flight. Where the mission has one drone, every file is of that one.
    """
    known = {drone.name: drone for drone in mission.drones}
    if told and len(told) != len(names):
        text = f"{len(told)} drones are named for {len(names)} files"
        return (), (Diagnostic(NOBODY, text, help="give `--drone` once for every file, in their order"),)
    found: dict[str, list[tuple[int, int]]] = {}
    faults: list[Diagnostic] = []
    for i, name in enumerate(names):
        drone, part = _of(name, known) if not told else (told[i], i)
        if drone in known:
            found.setdefault(drone, []).append((part, i))
        else:
            faults.append(_nobody(name, told[i] if told else "", list(known)))
    faults += _twice(found, names)
    owned = tuple(
        Owned(drone, tuple(i for _, i in sorted(found[drone.name])))
        for drone in mission.drones
        if drone.name in found
    )
    return owned, tuple(faults)


def _of(name: str, known: dict[str, Drone]) -> tuple[str, int]:
    """Return the drone of a file and the number of the part that it is, from 0."""
    stem = PurePath(name).stem
    if stem in known:
        return stem, 0
    match = PART.fullmatch(stem)
    assert match is not None
    drone, part = match["drone"], int(match["part"] or 1) - 1
    if drone in known:
        return drone, part
    return (next(iter(known)), part) if len(known) == 1 else ("", 0)


def _nobody(name: str, told: str, known: list[str]) -> Diagnostic:
    drones = ", ".join(f"`{drone}`" for drone in known)
    message = (
        f"the mission has no drone `{told}`" if told else f"`{name}` is named after no drone of the mission"
    )
    return Diagnostic(
        NOBODY,
        message,
        (Label(name, WHOLE_FILE),),
        (f"its drones are {drones}" if known else "it has no drone that films",),
        "name each file after its drone, as `cam1.kmz`, or say whose it is with `--drone NAME`",
    )


def _twice(found: dict[str, list[tuple[int, int]]], names: Sequence[str]) -> list[Diagnostic]:
    """Report files that claim to be the same part of one drone's flight."""
    faults = []
    for drone, files in found.items():
        parts = [part for part, _ in files]
        again = [names[i] for part, i in files if parts.count(part) > 1]
        if again:
            text = f"{' and '.join(f'`{name}`' for name in again)} are both the flight of `{drone}`"
            help_ = "name the parts of one flight `cam1-1.kmz`, `cam1-2.kmz`, or give `--drone` for each file"
            faults.append(Diagnostic(NOBODY, text, (Label(again[-1], WHOLE_FILE),), help=help_))
    return faults
