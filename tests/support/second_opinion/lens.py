"""The lens of a flight in its mission file: the zoom that a file cannot carry, and where it is focused."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.support.second_opinion.case import Case
from tests.support.second_opinion.flight import HFOV, Array, Flight, Phase
from tests.support.second_opinion.picture import Camera
from tests.support.second_opinion.vehicle import Flown

CARRIED = 0.05  # half frames at the edge of the picture, up to which a file may leave out a promised zoom
SHARP_SHARE = 0.5  # of the circle of confusion that the disc of one focus may reach
CENTIMETRES = 5e-3  # metres by which a focus with two decimals is rounded
FULL_FRAME = 0.036  # metres, the width of a sensor that nobody states
PROMISES = {"in_frame", "screen_error", "size"}


def withheld(case: Case, flight: Flight) -> bool:
    """Return whether no file may be written for a flight: its lens is not known, and a shot that promises its
    framing zooms.
    """
    drone = case.drones[flight.drone]
    if drone["lens"] is not None:
        return False
    promising = {shot["id"] for shot in case.mission.shots if PROMISES & shot.get("require", {}).keys()}
    return any(
        _off_edge(flight, phase, drone["hfov"]) > CARRIED
        for phase in flight.phases
        if phase.shot in promising
    )


def _off_edge(flight: Flight, phase: Phase, stands: float) -> float:
    """Return how far the edge of the picture is off at most, half frames, of a lens that stands."""
    inside = flight.dense[(flight.dense >= phase.start) & (flight.dense <= phase.end)]
    wide = np.tan(flight.at(inside)[:, HFOV] / 2)
    return float(np.abs(wide / np.tan(stands / 2) - 1.0).max())


def discs(
    case: Case, flight: Flight, phase: Phase, times: Array, flown: Flown, reach: float
) -> Iterator[Any]:
    """Yield the times of a shot and the disc as which its subject is shown there, over what is sharp.

    flown : what is flown in its recording; reach : metres within which it is at the planned place
    """
    optics = case.drones[flight.drone]["optics"]
    (shot,) = (s for s in case.mission.shots if s["id"] == phase.shot)
    if optics is None or optics["aperture"] is None or "focus" in shot:
        return
    for t, state in zip(times, flight.at(times), strict=True):
        spans = [f for f in flight.framing if f["shot"] == phase.shot and f["start"] <= t <= f["end"]]
        beside = np.linalg.norm(flown.place - state[:3], axis=1) <= reach
        if len(spans) != 1 or not beside.any():
            continue
        camera = Camera.of(state[None], float(case.drones[flight.drone]["aspect"]))
        centre = case.mission.targets[spans[0]["target"]].at(np.array([t]))
        depth = float(camera.project(centre[None])[1][0, 0])
        focal = (optics["sensor"] or FULL_FRAME) / (2 * float(np.tan(state[HFOV] / 2)))
        focus = flown.focus[beside]
        off = np.maximum(np.abs(depth - focus) - CENTIMETRES, 0.0)
        disc = focal**2 * off / (optics["aperture"] * (focus - focal) * depth)
        yield float(t), float(np.nan_to_num(disc, nan=np.inf).min()) / optics["circle"]
