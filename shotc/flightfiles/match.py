"""Finds the drone of a flight file, from the file's name or from the user's options."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.flightfiles.clocked import ClockedFlight
from shotc.flightfiles.course import FAR_M
from shotc.importers.flights.points import FAR, NOBODY
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.show import Fleet, drone_names
from shotc.source.file import WHOLE_FILE

MOST_NAMED_DRONES = 5
"""Most drones that are named in a message."""
ON_PAD_M = 1.0
"""Metres from a pad, within which a drone of a show stands on it."""
PART = re.compile(r"(?P<drone>.+?)(?:-(?P<part>[1-9][0-9]?))?(?:-litchi)?", re.IGNORECASE)


class Owned(NamedTuple):
    """A drone with the indices of its files, in the order of flight."""

    drone: Drone
    files: tuple[int, ...]


def owners(
    mission: MissionIR, names: Sequence[str], given: Sequence[str]
) -> tuple[tuple[Owned, ...], tuple[Diagnostic, ...]]:
    """Return the drones that have files, in the mission's order, and faults on files without a drone.

    A file belongs to the drone that it is named after: ``cam1.kmz``, ``cam1-litchi.csv``, or ``cam1-1.kmz``
    and so on for the parts of one flight. If the mission has one drone, every file belongs to it.

    names : of the files
    given : drone of each file by the user's options, or empty
    """
    known = {drone.name: drone for drone in mission.drones}
    parts: dict[str, list[tuple[int, int]]] = {}
    faults: list[Diagnostic] = []
    for i, name in enumerate(names):
        drone, part = _of(name, known) if not given else (given[i], i)
        if drone in known:
            parts.setdefault(drone, []).append((part, i))
        else:
            faults.append(_nobody(name, given[i] if given else "", list(known)))
    faults += _twice(parts, names)
    owned = tuple(
        Owned(drone, tuple(i for _, i in sorted(parts[drone.name])))
        for drone in mission.drones
        if drone.name in parts
    )
    return owned, tuple(faults)


def _of(name: str, known: dict[str, Drone]) -> tuple[str, int]:
    """Return the drone of a file, "" if unknown, and the index of the file's part of the flight, from 0."""
    stem = PurePath(name).stem
    if stem in known:
        return stem, 0
    match = PART.fullmatch(stem)
    assert match is not None
    drone, part = match["drone"], int(match["part"] or 1) - 1
    if drone in known:
        return drone, part
    return (next(iter(known)), part) if len(known) == 1 else ("", 0)


def _nobody(name: str, given: str, known: list[str]) -> Diagnostic:
    drones = ", ".join(f"`{drone}`" for drone in known)
    message = (
        f"the mission has no drone `{given}`" if given else f"`{name}` is named after no drone of the mission"
    )
    return Diagnostic(
        NOBODY,
        message,
        (Label(name, WHOLE_FILE),),
        (f"its drones are {drones}" if known else "it has no drone that films",),
        "name each file after its drone, as `cam1.kmz`, or say whose it is with `--drone NAME`",
    )


def _twice(by_drone: dict[str, list[tuple[int, int]]], names: Sequence[str]) -> list[Diagnostic]:
    """Report files that are the same part of one drone's flight."""
    faults = []
    for drone, files in by_drone.items():
        parts = [part for part, _ in files]
        again = [names[i] for part, i in files if parts.count(part) > 1]
        if again:
            text = f"{' and '.join(f'`{name}`' for name in again)} are both the flight of `{drone}`"
            help_ = "name the parts of one flight `cam1-1.kmz`, `cam1-2.kmz`, or give `--drone` for each file"
            faults.append(Diagnostic(NOBODY, text, (Label(again[-1], WHOLE_FILE),), help=help_))
    return faults


def named(
    mission: MissionIR, flights: Sequence[ClockedFlight], others: Collection[str]
) -> tuple[dict[str, ClockedFlight], tuple[Diagnostic, ...]]:
    """Return flights on the clock by the names of the mission's drones, and the faults.

    If no name in a show file is known, each drone gets the name of the pad on which it stands.

    others : drones that have another file
    """
    pads = {name: pad for f in mission.fleets for name, pad in zip(drone_names(f), f.pads, strict=True)}
    pads |= {drone.name: drone.home for drone in mission.drones}
    flights = _by_pads(flights, pads)
    by_name: dict[str, ClockedFlight] = {}
    faults: list[Diagnostic] = []
    for flight in flights:
        if flight.name not in pads:
            label = flight.at(0.0)._replace(text="")
            faults.append(
                _nobody(flight.file, flight.name, list(pads)[:MOST_NAMED_DRONES])._replace(labels=(label,))
            )
        elif (astray := _far_from_pad(flight, pads[flight.name])) is not None:
            faults.append(astray)
        elif flight.name in by_name or flight.name in others:
            text = f"`{flight.name}` has two flights"
            faults.append(Diagnostic(NOBODY, text, (flight.at(0.0),), help="give one flight for each drone"))
        else:
            by_name[flight.name] = flight
    if not faults:
        faults += [fault for fleet in mission.fleets if (fault := _incomplete(fleet, by_name)) is not None]
    return by_name, tuple(faults[:MOST_NAMED_DRONES])


def _far_from_pad(flight: ClockedFlight, pad: Vec3) -> Diagnostic | None:
    """Report a flight that is far from its pad."""
    distances = np.linalg.norm(flight.curve.ctrl - np.array(pad), axis=2)
    piece = int(np.argmax(distances.max(axis=1)))
    if distances[piece].max() <= FAR_M:
        return None
    kilometres = distances[piece].max() / 1000
    where = flight.at(float(flight.curve.breaks[piece + 1]))
    text = f"`{flight.file}` cannot be judged: `{flight.name}` is {kilometres:.0f} km from its pad there"
    help_ = "see the origin and the units of the file, and world.origin of the mission"
    return Diagnostic(FAR, text, (where,), help=help_)


def _by_pads(flights: Sequence[ClockedFlight], pads: dict[str, Vec3]) -> list[ClockedFlight]:
    """Return flights with the names of their start pads, for files in which no drone has a known name."""
    known = {flight.file for flight in flights if flight.name in pads}
    return [flight if flight.file in known else _on_its_pad(flight, pads) for flight in flights]


def _on_its_pad(flight: ClockedFlight, pads: dict[str, Vec3]) -> ClockedFlight:
    distances = np.linalg.norm(np.array(list(pads.values())) - flight.curve.ctrl[0, 0], axis=1)
    nearest = int(np.argmin(distances))
    stands = flight.show and distances[nearest] <= ON_PAD_M
    return replace(flight, name=list(pads)[nearest]) if stands else flight


def _incomplete(fleet: Fleet, flights: dict[str, ClockedFlight]) -> Diagnostic | None:
    """Report a fleet of which only some drones have a flight."""
    missing = [name for name in drone_names(fleet) if name not in flights]
    if not missing or len(missing) == len(fleet.pads):
        return None
    count = len(fleet.pads) - len(missing)
    some = ", ".join(f"`{name}`" for name in missing[:MOST_NAMED_DRONES])
    more = f" and {len(missing) - MOST_NAMED_DRONES} more" if len(missing) > MOST_NAMED_DRONES else ""
    file = next(flight.file for name, flight in flights.items() if name in drone_names(fleet))
    return Diagnostic(
        NOBODY,
        f"the files have {count} flights of fleet `{fleet.name}`, which has {len(fleet.pads)} drones",
        (Label(file, WHOLE_FILE),),
        (f"without a flight: {some}{more}",),
        "give the flights of all its drones, or `count` as many as there are",
    )
