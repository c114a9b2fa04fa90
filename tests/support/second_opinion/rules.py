"""Hard rules and the certificate, against what dense samples find."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tests.support.second_opinion.case import Case, Finding, Findings
from tests.support.second_opinion.measures import Worst
from tests.support.second_opinion.quantities import number

SLACK = 1e-6  # of a limit, and of its unit, by which it may be exceeded: what ``outputs.md`` allows a claim
EXACT = 1e-6  # by which a value that is claimed to be exact may differ, absolute and of the value


def limits_kept(worst: Iterable[Worst]) -> Findings:
    """Every limit, whatever the certificate says of it."""
    for found in worst:
        if found.broken_by > SLACK * max(1.0, abs(found.limit)):
            yield Finding(found.name, found.drone, found.value, found.limit, found.time)


def claimed(case: Case, worst: Iterable[Worst]) -> Findings:
    """The certificate has a claim of every measure, with its limit, and no sample is worse than the claim."""
    claims = {(c["constraint"], c["subject"], c["shot"]): c for c in case.plan["certificate"]}
    for found in worst:
        claim = claims.get((found.name, found.drone, None))
        if claim is None:
            yield Finding(f"no claim: {found.name}", found.drone, found.value, found.limit, found.time)
            continue
        limit = float(claim["limit"])
        if not np.isclose(limit, found.limit, rtol=1e-9, atol=1e-9):
            yield Finding(f"limit of {found.name}", found.drone, limit, found.limit)
        beyond = (found.value - claim["worst"]) * (1.0 if found.upper else -1.0)
        slack = EXACT * max(1.0, abs(found.value))
        if beyond > slack or (claim["method"] == "exact" and abs(beyond) > slack):
            yield Finding(f"claimed {found.name}", found.drone, found.value, claim["worst"], found.time)


def claims_hold(case: Case) -> Findings:
    """No claim is broken by its own numbers, and its word ``holds`` is true: both as ``outputs.md`` says.

    A transit that begins or ends at a shot nearer than its clearance reaches its limit there, as the page
    defines the value, and the proved bound on it lies below.
    """
    for claim in case.plan["certificate"]:
        worst, limit = float(claim["worst"]), float(claim["limit"])
        broken = (worst - limit) if claim["upper"] else (limit - worst)
        rounding = SLACK * max(1.0, abs(limit)) if np.isfinite(limit) else 0.0
        says = claim["holds"]
        if (broken > rounding and (says or claim["hard"])) or (broken < -rounding and not says):
            yield Finding(f"holds: {claim['constraint']}", claim["subject"], worst, limit, claim["time"])


def joints(case: Case) -> Findings:
    """All channels are twice continuously differentiable, but for rounding that is claimed truly."""
    stated = {"jump of value": 1e-6, "jump of rate": 1e-6, "jump of acceleration": 1e-4}
    for flight in case.flights.values():
        values = flight.pieces[1]
        claims = {
            c["constraint"]: c["worst"] for c in case.plan["certificate"] if c["subject"] == flight.drone
        }
        for order, (name, limit) in enumerate(stated.items()):
            steps = np.abs(values[order][1:, 0] - values[order][:-1, -1])
            found = float(steps.sum(axis=0).max(initial=0.0))
            if found > limit:
                yield Finding(name, flight.drone, found, limit)
            if abs(found - claims.get(name, np.inf)) > 0.01 * limit:
                yield Finding(f"claimed {name}", flight.drone, found, claims.get(name, np.inf))


def phases_in_order(case: Case) -> Findings:
    """Phases have no gaps and fill the flight, which begins with a take-off and ends with a landing."""
    for flight in case.flights.values():
        edges = [flight.start, *(p.end for p in flight.phases)]
        gaps = [abs(p.start - edge) for p, edge in zip(flight.phases, edges, strict=False)]
        gap = max([*gaps, abs(edges[-1] - flight.end)])
        if gap > 1e-9:
            yield Finding("phases without gaps", flight.drone, gap, 0.0)
        if (flight.phases[0].name, flight.phases[-1].name) != ("takeoff", "land"):
            yield Finding("take-off first and landing last", flight.drone, 1.0, 0.0)
        shortest = min(p.end - p.start for p in flight.phases)
        if shortest <= 0:
            yield Finding("phases that last", flight.drone, shortest, 0.0)


def drones_as_written(case: Case) -> Findings:
    """What the author wrote of a drone stands in the plan, whatever its model has."""
    for name, written in case.mission.written["drones"].items():
        drone = case.drones[name]
        for where, wanted in _numbers(written, case):
            found: Any = drone
            for key in where:
                found = found[key]
            if not np.isclose(float(found), wanted, rtol=1e-9, atol=1e-9):
                yield Finding(f"as written: {'.'.join(map(str, where))}", name, float(found), wanted)


def _numbers(written: dict[str, Any], case: Case) -> Iterable[tuple[tuple[Any, ...], float]]:
    for k, home in enumerate(case.mission.at(written["home"])):
        yield ("home", k), float(home)
    for key, value in written.get("limits", {}).items():
        wind = case.mission.wind if key == "speed" else 0.0  # plan.json has it over ground
        yield ("limits", key), number(value) - wind
    for key, value in written.get("gimbal", {}).items():
        if isinstance(value, list):
            yield from ((("gimbal", key, k), number(part)) for k, part in enumerate(value))
        else:
            yield ("gimbal", key), number(value)
    for key in ("radius", "endurance"):
        if key in written:
            yield (key,), number(written[key])
    yield from _camera(written.get("camera", {}))


def _camera(camera: dict[str, Any]) -> Iterable[tuple[tuple[Any, ...], float]]:
    if "hfov" in camera:
        yield ("hfov",), number(camera["hfov"])
    if "focal_length" in camera:
        sensor = camera["sensor"] if isinstance(camera["sensor"], list) else [camera["sensor"]]
        yield ("hfov",), 2 * np.arctan(number(sensor[0]) / 2 / number(camera["focal_length"]))
        if len(sensor) == 2:
            yield ("aspect",), number(sensor[0]) / number(sensor[1])
    if "aspect" in camera:
        wide, _, high = str(camera["aspect"]).partition(":")
        yield ("aspect",), float(wide) / float(high or 1.0)
