"""What the mission asks of its shots: drones, times, places that bind, holds, and the course of a kind."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.support.second_opinion.case import Case, Finding, Findings
from tests.support.second_opinion.flight import Array, Flight, Phase
from tests.support.second_opinion.mission import SEPARATION
from tests.support.second_opinion.quantities import number

CLOCK = 1e-3  # seconds by which a time that was asked for may be missed
PLACE = 1e-3  # metres by which a place that was asked for may be missed
FOLLOWING = 0.01  # metres, where the camera turns after what moves
PREFERRED, REQUIRED = 0.2, 0.5  # of the distance to its target, by which pictures of others may move a shot
TURN = np.radians(10.0)  # by which an arc that bends round something may end beside its bearing


def shots_asked(case: Case) -> Findings:
    """Every shot is flown once, by its drone, when and where it was asked for."""
    where = {
        p.shot: (flight, p) for flight in case.flights.values() for p in flight.phases if p.shot is not None
    }
    count = sum(p.shot is not None for flight in case.flights.values() for p in flight.phases)
    if count != len(case.mission.shots):
        yield Finding("shots flown once", "mission", count, len(case.mission.shots))
    for shot in case.mission.shots:
        if shot["id"] not in where:
            yield Finding("shot is flown", shot["id"], 0, 1)
            continue
        flight, phase = where[shot["id"]]
        if shot["drone"] not in ("auto", flight.drone):
            yield Finding("shot by its drone", shot["id"], 0, 1)
        yield from _times(shot, phase, {k: p for k, (_, p) in where.items()})
        if shot["kind"] == "keyframes":
            yield from _keyframes(case, shot, flight, phase)
        if shot["kind"] == "static":
            yield from _static(case, shot, flight, phase)
        if shot["kind"] in ("orbit", "spiral"):
            yield from _arc(case, shot, flight, phase)
        if shot["kind"] in ("elevator", "dolly", "crane"):
            yield from _line(case, shot, flight, phase)


def shots_in_order(case: Case) -> Findings:
    """Shots of one drone run in the order written unless ``start`` says otherwise."""
    for flight in case.flights.values():
        flown = [p.shot for p in flight.phases if p.shot is not None]
        mine = [s for s in case.mission.shots if s["id"] in flown]
        if any("start" in _timing(s) for s in mine):
            continue
        if flown != [s["id"] for s in mine]:
            yield Finding("order of shots", flight.drone, 1, 0)


def _timing(shot: dict[str, Any]) -> dict[str, Any]:
    timing = shot.get("timing", "auto")
    return {} if timing == "auto" else dict(timing)


def _times(shot: dict[str, Any], phase: Phase, phases: dict[str | None, Phase]) -> Findings:
    timing = _timing(shot)
    lasts = phase.end - phase.start
    if "duration" in timing and abs(lasts - number(timing["duration"])) > CLOCK:
        yield Finding("duration", shot["id"], lasts, number(timing["duration"]))
    if "start" in timing and abs(phase.start - number(timing["start"])) > CLOCK:
        yield Finding("start", shot["id"], phase.start, number(timing["start"]))
    if "after" in timing and phase.start < phases[timing["after"]].end - CLOCK:
        yield Finding("after", shot["id"], phase.start, phases[timing["after"]].end)


def _keyframes(case: Case, shot: dict[str, Any], flight: Flight, phase: Phase) -> Findings:
    reached = {mark["index"]: mark["time"] for mark in flight.keyframes if mark["shot"] == shot["id"]}
    if sorted(reached) != list(range(len(shot["keyframes"]))):
        yield Finding("keyframes reached", shot["id"], len(reached), len(shot["keyframes"]))
        return
    times = [reached[k] for k in range(len(reached))]
    holds = [number(k.get("hold", 0.0)) for k in shot["keyframes"]]
    if times != sorted(times) or times[0] < phase.start - CLOCK or times[-1] + holds[-1] > phase.end + CLOCK:
        yield Finding("keyframes in order within the shot", shot["id"], times[-1], phase.end)
    for k, keyframe in enumerate(shot["keyframes"]):
        subject = f"{shot['id']} keyframe {k + 1}"
        t = np.linspace(times[k], times[k] + holds[k], 200 if holds[k] else 1)
        if "time" in keyframe and abs(times[k] - phase.start - number(keyframe["time"])) > CLOCK:
            yield Finding("time of keyframe", subject, times[k] - phase.start, number(keyframe["time"]))
        if not (isinstance(keyframe["at"], dict) and "from" in keyframe["at"]):
            yield from _stays(subject, flight, t, case.mission.at(keyframe["at"]))


def _static(case: Case, shot: dict[str, Any], flight: Flight, phase: Phase) -> Findings:
    if isinstance(shot["at"], dict) and "from" in shot["at"]:
        return
    t, at = np.linspace(phase.start, phase.end, 400), case.mission.at(shot["at"])
    name = shot.get("look_at", shot.get("target"))
    target = case.mission.targets.get(name if isinstance(name, str) else shot.get("target"))
    if target is None or not target.moves:
        yield from _stays(shot["id"], flight, t, at)
        return
    yield from _stays(shot["id"], flight, t, at, _moved_by_others(case, flight, target.at(t), (t, at)))


def _moved_by_others(case: Case, flight: Flight, filmed: Array, stand: tuple[Array, Array]) -> float:
    """Return how far other drones may move a camera that turns after something: for pictures, or near it."""
    t, at = stand
    others = [case.place(name, t) for name in case.drones if name != flight.drone]
    if not others:
        return FOLLOWING
    rule = case.mission.rules.get("mutual_visibility", "prefer")
    strength = rule.get("strength", "require") if isinstance(rule, dict) else rule
    share = {"prefer": PREFERRED, "require": REQUIRED}.get(strength, 0.0)
    apart = case.mission.rule("separation", SEPARATION) + 1.0
    near = [2 * apart for place in others if np.linalg.norm(place - at, axis=1).min() < apart]
    return FOLLOWING + share * float(np.linalg.norm(filmed - at, axis=1).max()) + sum(near)


def _stays(subject: str, flight: Flight, t: Array, at: Array, within: float = PLACE) -> Findings:
    off = np.linalg.norm(flight.at(t)[:, :3] - at, axis=1)
    if off.max() > within:
        yield Finding("place of keyframe", subject, float(off.max()), 0.0, float(t[off.argmax()]))


def _about(case: Case, shot: dict[str, Any], flight: Flight, t: Array) -> Array:
    """Return the camera from the target's foot at times (M,), shape (M, 3)."""
    target = case.mission.targets[shot["target"]]
    return flight.at(t)[:, :3] - target.at(t) + [0, 0, target.height / 2]


def _left(case: Case, shot: str) -> float:
    """Return how far the plan says that it leaves the ideal of a shot, metres."""
    told = [float(d["distance"]) for d in case.plan["deviations"] if d["shot"] == shot]
    claims = [float(c["worst"]) for c in case.plan["certificate"]
              if c["shot"] == shot and c["constraint"] == "distance from its place"]  # fmt: skip
    return max([0.0, *told, *claims])


def _arc(case: Case, shot: dict[str, Any], flight: Flight, phase: Phase) -> Findings:
    """An orbit or spiral goes round by its sweep, from its azimuth, at its radius and height."""
    t = np.linspace(phase.start, phase.end, 4000)
    from_foot = _about(case, shot, flight, t)
    round_ = np.unwrap(np.arctan2(from_foot[:, 1], from_foot[:, 0]))
    sweep = number(shot.get("sweep", "360 deg"))
    if abs(round_[-1] - round_[0] - sweep) > TURN:
        yield Finding("sweep", shot["id"], float(round_[-1] - round_[0]), sweep)
    if round_[-1] == round_[0]:
        return
    if "start_azimuth" in shot:
        off = (np.pi / 2 - round_[0] - number(shot["start_azimuth"]) + np.pi) % (2 * np.pi) - np.pi
        if abs(off) > TURN:
            yield Finding("start azimuth", shot["id"], float(off), 0.0, phase.start)
    allowed = _left(case, shot["id"]) + 0.02 * np.hypot(from_foot[:, 0], from_foot[:, 1]).max() + PLACE
    for name, values in (
        ("radius", np.hypot(from_foot[:, 0], from_foot[:, 1])),
        ("altitude", from_foot[:, 2]),
    ):
        first, last = _both(shot[name])
        wanted = first + (last - first) * (round_ - round_[0]) / (round_[-1] - round_[0])
        off = np.abs(values - wanted)
        if off.max() > allowed:
            yield Finding(name, shot["id"], float(off.max()), allowed, float(t[off.argmax()]))


def _line(case: Case, shot: dict[str, Any], flight: Flight, phase: Phase) -> Findings:
    """An elevator, dolly or crane stands at its bearing, and goes between its distances and heights."""
    first, last = _about(case, shot, flight, np.array([phase.start, phase.end]))
    bearing = number(shot["azimuth"])
    for end, (moment, found) in enumerate(((phase.start, first), (phase.end, last))):
        level = _both(shot["distance"])[end]
        wanted = np.array([np.sin(bearing) * level, np.cos(bearing) * level, _both(shot["altitude"])[end]])
        off = float(np.linalg.norm(found - wanted))
        if off > _left(case, shot["id"]) + PLACE:
            yield Finding("place of kind", shot["id"], off, 0.0, moment)


def _both(value: Any) -> tuple[float, float]:
    if isinstance(value, dict):  # what an altitude above the target is, it is without saying so
        assert value["above"] == "target"
        return _both(value["height"])
    if isinstance(value, list):
        return number(value[0]), number(value[1])
    return number(value), number(value)
