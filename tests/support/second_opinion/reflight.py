"""The mission files, flown by a vehicle of our own, against the plan and against what is said of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tests.support.second_opinion.case import Case, Finding, Findings
from tests.support.second_opinion.flight import BODY_YAW, CAM_PITCH, CAM_YAW, Array, Flight, Phase
from tests.support.second_opinion.framing import ticks_of
from tests.support.second_opinion.lens import SHARP_SHARE, discs, withheld
from tests.support.second_opinion.mission_files import read
from tests.support.second_opinion.picture import Camera
from tests.support.second_opinion.vehicle import KNOWN, LAND, STEP, TAKEOFF, Flown, fly

NOTE = re.compile(
    r"^(?:px4|ardupilot) (?P<file>.+): (?P<items>\d+) items, position within (?P<position>[\d.]+) m"
    r"(?:, heading within (?P<heading>[\d.]+) deg, adds at most (?P<screen>[\d.]+) of the screen "
    r".*take about (?P<filmed>\d+) s where the plan films (?P<planned>\d+) s)?$"
)
EARTH = 2e-3  # metres by which four decimals of a metre and nine of a degree, twice, move a waypoint
AHEAD = 4000  # points of a way among which the next one is looked for
BACK = 50  # of them that one may go back: half a metre, in which a drone that waits swings
ROUNDING = 1e-3  # rad and half frames
TURNING = np.radians(1.0)  # by which the heading at a place depends on how fast a vehicle speeds up and turns
PACE = (
    0.15  # share of the time of straight legs that corners may take more, beside one start from rest a shot
)


class Said(NamedTuple):
    """What a note says of a file: metres, rad, half frames, seconds; NaN where nothing is filmed."""

    items: int
    position: float
    heading: float
    screen: float
    filmed: float
    planned: float


@dataclass(frozen=True)
class Reflight:
    """One file as it is flown, and the flight that it is to be."""

    case: Case
    flight: Flight
    name: str
    flown: Flown
    said: Said

    def finding(self, rule: str, found: float, limit: float, time: float | None = None) -> Finding:
        return Finding(rule, self.name, float(found), float(limit), time)


def reflights(case: Case) -> Findings:
    """Yield where a mission file does not fly as the plan does, by what is said of it."""
    origin = case.mission.origin
    if origin is None:
        return
    said = dict(_said(case.notes))
    for drone, flight in case.flights.items():
        written = case.drones[drone]
        if withheld(case, flight):
            written_still = [name for name in case.files if name in (f"{drone}.plan", f"{drone}.waypoints")]
            yield from (Finding("file without its promised zoom", name, 1, 0) for name in written_still)
            continue
        endings = ("plan", "waypoints") if written["autopilot"] == "ardupilot" else ("plan",)
        for name in (f"{drone}.{ending}" for ending in endings):
            if name not in case.files or name not in said:
                yield Finding("mission file and its note", name, 0, 1)
                continue
            file = read(name, case.files[name], origin)
            commands = [item.command for item in file.items]
            if len(commands) != said[name].items:
                yield Finding("items", name, len(commands), said[name].items)
            if (commands[0], commands[-1]) != (TAKEOFF, LAND) or not KNOWN.issuperset(commands):
                yield Finding("commands", name, len(set(commands) - KNOWN), 0)
                continue
            off = float(np.linalg.norm(file.at_home() - written["home"]))
            if off > EARTH:
                yield Finding("home", name, off, 0.0)
            yaw = float(flight.at(np.array([flight.start]))[0, BODY_YAW])
            yield from _judged(Reflight(case, flight, name, fly(file, written, yaw), said[name]))


def _said(notes: tuple[str, ...]) -> Iterator[tuple[str, Said]]:
    for found in filter(None, map(NOTE.match, notes)):
        of = {key: float(value or "nan") for key, value in found.groupdict().items() if key != "file"}
        yield (
            found["file"],
            Said(
                int(of["items"]),
                of["position"],
                np.radians(of["heading"]),
                of["screen"],
                of["filmed"],
                of["planned"],
            ),
        )


def _judged(one: Reflight) -> Findings:
    yield from _ways(one)
    filmed = sorted((p for p in one.flight.phases if p.shot is not None), key=lambda p: p.start)
    recordings = int(one.flown.recording.max()) + 1
    if recordings != len(filmed):
        yield one.finding("recordings", recordings, len(filmed))
        return
    if filmed:
        seconds = sum(p.end - p.start for p in filmed)
        if abs(seconds - one.said.planned) > 1.0:
            yield one.finding("planned seconds of film", seconds, one.said.planned)
        limits = one.case.drones[one.flight.drone]["limits"]
        starts = len(filmed) * limits["speed"] / limits["acceleration"]
        if not -1.0 <= one.said.filmed - one.flown.filmed <= 1.0 + starts + PACE * one.said.filmed:
            yield one.finding("flown seconds of film", one.flown.filmed, one.said.filmed)
    for number, phase in enumerate(filmed):
        yield from _filmed(one, number, phase)


def _ways(one: Reflight) -> Findings:
    """The plan goes along the flown way and that along the plan, both in order, as near as is said."""
    first, last = one.flight.phases[0].end, one.flight.phases[-1].start
    planned = _moving(one.flight.at(np.arange(first, last, 0.005))[:, :3])
    way = one.flown.place
    for rule, points, path in (
        ("plan beside the way", planned[::10], way),
        ("way beside the plan", way[::5], planned),
    ):
        lost = _lost(points, path, one.said.position + EARTH)
        if lost is not None:
            yield one.finding(rule, lost, one.said.position)


def _moving(places: Array) -> Array:
    """Return places without those at which it rests."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    return np.asarray(places[np.unique(np.floor(along / (STEP / 2)), return_index=True)[1]])


def _lost(points: Array, path: Array, near: float) -> float | None:
    """Return how far the first point is that lies too far from a path (K, 3) on which one goes on."""
    reach = np.hypot(near, np.linalg.norm(np.diff(path, axis=0), axis=1).max() / 2)
    at = 0
    for point in points:
        first = max(at - BACK, 0)
        away = np.linalg.norm(path[first : at + AHEAD] - point, axis=1)
        if away.min() > reach:
            return float(away.min())
        at = first + int((away <= reach).argmax())
    return None


def _filmed(one: Reflight, number: int, phase: Phase) -> Findings:
    """In a recording the body is turned, and the picture stands, as near to the plan as is said."""
    flown = one.flown.some(one.flown.recording == number)
    times = ticks_of(one.case, phase)
    worst = {"heading": (0.0, 0.0), "picture": (0.0, 0.0)}
    for t, state in zip(times, one.flight.at(times), strict=True):
        beside = np.linalg.norm(flown.place - state[:3], axis=1) <= one.said.position + EARTH + STEP
        if not beside.any():
            yield one.finding("place in the film", 1.0, 0.0, float(t))
            return
        off = (flown.body[beside] - state[BODY_YAW] + np.pi) % (2 * np.pi) - np.pi
        worst["heading"] = max(worst["heading"], (float(np.abs(off).min()), float(t)))
        shift = _shift(one, phase, float(t), state, flown.some(beside))
        worst["picture"] = max(worst["picture"], (shift, float(t)))
    reach = one.said.position + EARTH + STEP
    for t, disc in discs(one.case, one.flight, phase, times, flown, reach):
        worst["focus"] = max(worst.get("focus", (0.0, 0.0)), (disc, t))
    limits = {"focus": SHARP_SHARE, "heading": one.said.heading + TURNING, "picture": one.said.screen}
    for rule, (found, t) in worst.items():
        if not found <= limits[rule] + ROUNDING:
            yield one.finding(f"{rule} in the film", found, limits[rule], t)


def _shift(one: Reflight, phase: Phase, t: float, state: Array, flown: Flown) -> float:
    """Return how far on screen the target is from where the plan has it, half frames; 0 where none is."""
    spans = [f for f in one.flight.framing if f["shot"] == phase.shot and f["start"] <= t <= f["end"]]
    if not spans:
        return 0.0
    states = np.tile(state, (len(flown.place) + 1, 1))
    states[1:, :3], states[1:, CAM_YAW : CAM_PITCH + 1] = flown.place, flown.aim
    centre = one.case.mission.targets[spans[-1]["target"]].at(np.array([t]))
    camera = Camera.of(states, float(one.case.drones[one.flight.drone]["aspect"]))
    screen, depth = camera.project(np.tile(centre, (len(states), 1, 1)))
    if depth[0, 0] <= 0:
        return 0.0
    away = np.where(depth[1:] > 0, screen[1:, 0] - screen[0, 0], np.nan)
    return _least(away, np.diff(flown.leg) == 0)


def _least(away: Array, joined: Array) -> float:
    """Return how near points (K, 2), and the lines from each to the next (K - 1,) joined one, come to (0, 0).

    The flown way is sampled; on a close picture half a step of it is as large as what is judged.
    """
    start, line = away[:-1][joined], np.diff(away, axis=0)[joined]
    length2 = np.maximum((line**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip(-(start * line).sum(axis=1) / length2, 0.0, 1.0)
    near = np.concatenate([away, start + share[:, None] * line])
    return float(np.nan_to_num(np.linalg.norm(near, axis=1), nan=np.inf).min())
