"""The worst value of everything that bounds a drone, found by dense samples.

Keys are the names of the certificate's claims, so that the two can be compared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from tests.support.second_opinion.case import Case
from tests.support.second_opinion.flight import AT_HOME, BODY_YAW, CAM_PITCH, CAM_YAW, HFOV, Array, Flight
from tests.support.second_opinion.mission import BESIDE_TARGETS, GROUND, SEPARATION, Zone

LENS = (np.radians(1.0), np.radians(170.0))
ROUNDED = np.radians(0.01)
GRAVITY = 9.80665
SUMMED = 1e-3  # of an energy that is summed from samples
FINE, ROUNDS = 15, 3  # a worst time is looked at again, this finely and often


class Worst(NamedTuple):
    """The worst of dense samples against a limit; upper : it must not be above."""

    name: str
    drone: str
    value: float
    limit: float
    upper: bool
    time: float

    @property
    def broken_by(self) -> float:
        """How far the value is on the wrong side, negative on the right one."""
        return self.value - self.limit if self.upper else self.limit - self.value


def worst_of(name: str, drone: str, limit: float, t: Array, values: Array, *, upper: bool = True) -> Worst:
    """Return the worst of values at times."""
    k = int(np.argmax(values) if upper else np.argmin(values))
    return Worst(name, drone, float(values.flat[k]), limit, upper, float(t.flat[k]))


def searched(
    name: str, drone: str, limit: float, spans: list[Array], value: Callable[[Array], Array]
) -> Worst:
    """Return the least value over spans of times, looked for again about the least sample."""
    least = []
    for t in spans:
        found = worst_of(name, drone, limit, t, value(t), upper=False)
        left, right = _beside(t, found.time)
        for _ in range(ROUNDS):
            near = np.linspace(left, right, FINE)
            again = worst_of(name, drone, limit, near, value(near), upper=False)
            found = min(found, again, key=lambda worst: worst.value)
            left, right = _beside(near, again.time)
        least.append(found)
    return min(least, key=lambda worst: worst.value)


def _beside(t: Array, time: float) -> tuple[float, float]:
    k = int(np.searchsorted(t, time))
    return float(t[max(k - 1, 0)]), float(t[min(k + 1, len(t) - 1)])


def all_measures(case: Case) -> Iterator[Worst]:
    """Yield the worst value of everything that binds a drone at all times."""
    for flight in case.flights.values():
        yield from limits(case, flight)
        yield from at_home(case, flight)
        yield from energy(case, flight)
        yield from clearances(case, flight)
    yield from separations(case)


def limits(case: Case, flight: Flight) -> Iterator[Worst]:
    """Motion, body and gimbal, over all pieces with both ends of each."""
    drone = case.drones[flight.drone]
    bound, gimbal = drone["limits"], drone["gimbal"]
    t, (value, rate, second, third) = flight.pieces
    yaw = value[..., CAM_YAW] - value[..., BODY_YAW]
    yaw_rate = np.abs(rate[..., CAM_YAW] - rate[..., BODY_YAW])
    yaw_second = np.abs(second[..., CAM_YAW] - second[..., BODY_YAW])
    norm = np.linalg.norm
    longest, widest, zoom_rate = _lens(case.drones[flight.drone])
    uppers = {
        "airspeed" if any(bound["wind"]) else "speed": (
            norm(rate[..., :2] - np.array(bound["wind"]), axis=-1),
            bound["speed"],
        ),
        "climb": (rate[..., 2], bound["climb"]),
        "descent": (-rate[..., 2], bound["descent"]),
        "acceleration": (norm(second[..., :3], axis=-1), bound["acceleration"]),
        "jerk": (norm(third[..., :3], axis=-1), bound["jerk"]),
        "body yaw rate": (np.abs(rate[..., BODY_YAW]), bound["yaw_rate"]),
        "body yaw acceleration": (np.abs(second[..., BODY_YAW]), bound["yaw_acceleration"]),
        "gimbal pitch max": (value[..., CAM_PITCH], gimbal["pitch"][1]),
        "gimbal yaw max": (yaw, gimbal["yaw"][1]),
        "gimbal pitch rate": (np.abs(rate[..., CAM_PITCH]), gimbal["rate"]),
        "gimbal pitch acceleration": (np.abs(second[..., CAM_PITCH]), gimbal["acceleration"]),
        "gimbal yaw rate": (yaw_rate, gimbal["rate"]),
        "gimbal yaw acceleration": (yaw_second, gimbal["acceleration"]),
        "field of view max": (value[..., HFOV], widest),
    }
    pushed = second[..., :3] + np.array([0.0, 0.0, GRAVITY])
    if zoom_rate is not None:
        uppers["zoom rate"] = np.abs(rate[..., HFOV]), zoom_rate
    if bound["tilt"] != "inf":
        upright = pushed[..., 2] / norm(pushed, axis=-1)
        uppers["tilt"] = np.arccos(np.clip(upright, -1.0, 1.0)), bound["tilt"]
    if bound["thrust_to_weight"] != "inf":
        uppers["thrust to weight"] = norm(pushed, axis=-1) / GRAVITY, bound["thrust_to_weight"]
    lowers = {
        "gimbal pitch min": (value[..., CAM_PITCH], gimbal["pitch"][0]),
        "gimbal yaw min": (yaw, gimbal["yaw"][0]),
        "field of view min": (value[..., HFOV], longest),
    }
    for name, (values, limit) in uppers.items():
        yield worst_of(name, flight.drone, float(limit), t, values)
    for name, (values, limit) in lowers.items():
        yield worst_of(name, flight.drone, float(limit), t, values, upper=False)


def _lens(drone: dict[str, Any]) -> tuple[float, float, float | None]:
    """Return the least and the largest field of view of a lens, and how fast it zooms where it does."""
    lens = drone["lens"]
    if lens is None:
        return (*LENS, None)
    fixed = lens["longest"] == lens["widest"]
    return lens["longest"] - ROUNDED, lens["widest"] + ROUNDED, None if fixed else lens["rate"]


def at_home(case: Case, flight: Flight) -> Iterator[Worst]:
    """Where a flight begins and ends, how it gets up and down, and how long it takes."""
    drone = case.drones[flight.drone]
    home = np.array(drone["home"])
    ends = np.array([flight.start, flight.end])
    away = np.linalg.norm(flight.at(ends)[:, :3] - home, axis=1)
    yield worst_of("distance from home", flight.drone, 1e-3, ends, away)
    rates = np.concatenate([np.abs(flight.at(ends, k)[:, :6]).max(axis=1) for k in (1, 2)])
    yield worst_of("rate at start and end", flight.drone, 1e-6, np.tile(ends, 2), rates)
    t = flight.during(AT_HOME)
    aside = np.linalg.norm(flight.at(t)[:, :2] - home[:2], axis=1)
    yield worst_of("drift from the vertical", flight.drone, 1e-6, t, aside)
    yield worst_of("depth below home", flight.drone, 0.0, t, np.maximum(home[2] - flight.at(t)[:, 2], 0.0))
    away = np.linalg.norm(flight.pieces[1][0][..., :3] - home, axis=-1).max(axis=1)
    moving = np.flatnonzero(away > 1e-12)  # pieces
    lasts = float(flight.curve.x[moving[-1] + 1] - flight.curve.x[moving[0]]) if len(moving) else 0.0
    yield Worst("endurance", flight.drone, lasts, float(drone["endurance"]), True, flight.end)


def energy(case: Case, flight: Flight) -> Iterator[Worst]:
    """What the battery gives from lift-off to touch-down, Wh, where the plan says what it is."""
    power = case.drones[flight.drone]["power"]
    if power is None:
        return
    t, (_, rate, second, _) = flight.pieces
    away = np.linalg.norm(flight.pieces[1][0][..., :3] - flight.pieces[1][0][0, 0, :3], axis=-1).max(axis=1)
    flown = slice(int(np.flatnonzero(away > 1e-12)[0]), None)
    pushed = power["mass"] * (second[flown, :, :3] + np.array([0.0, 0.0, GRAVITY]))
    thrust = np.linalg.norm(pushed, axis=-1)
    disc = 2.0 * power["density"] * power["rotors"] * np.pi * power["radius"] ** 2
    climbing = 0.5 * np.sum(pushed * rate[flown, :, :3], axis=-1)
    watts = (thrust * np.sqrt(thrust / disc) + climbing) / power["efficiency"]
    joules = float(np.trapezoid(watts, t[flown], axis=1).sum())
    limit = (1.0 - power["reserve"]) * power["battery"] / 3600.0
    # A sum of samples is exact to about a thousandth, and the claim must not be below the energy.
    yield Worst("energy", flight.drone, (1.0 - SUMMED) * joules / 3600.0, limit, True, flight.end)


def clearances(case: Case, flight: Flight) -> Iterator[Worst]:
    """Zones, targets and the ground, of the body's sphere."""
    mission, radius = case.mission, case.drones[flight.drone]["radius"]
    aloft, low = flight.spans(AT_HOME, outside=True), flight.spans(AT_HOME)
    for zone in mission.zones:
        yield from _zone(flight, zone, radius)

    def height(t: Array) -> Array:
        return flight.at(t)[:, 2] - radius

    yield searched("ground clearance", flight.drone, mission.rule("ground_clearance", GROUND), aloft, height)
    for target in (body for body in mission.targets.values() if not body.parts):

        def room(t: Array, target=target) -> Array:
            return target.room(flight.at(t)[:, :3], t) - radius

        needed = mission.rule("target_clearance", BESIDE_TARGETS)
        yield searched(f"target {target.name}", flight.drone, needed, aloft, room)
        yield searched(f"target {target.name} at home", flight.drone, 0.0, low, room)


def _zone(flight: Flight, zone: Zone, radius: float) -> Iterator[Worst]:
    aloft, low = flight.spans(AT_HOME, outside=True), flight.spans(AT_HOME)

    def inside(t: Array) -> Array:
        return zone.solid.depth(flight.at(t)[:, :3]) - radius

    def outside(t: Array) -> Array:
        return zone.solid.distance(flight.at(t)[:, :3]) - radius

    if zone.keeps_in:
        yield searched(f"zone {zone.name}", flight.drone, 0.0, aloft, inside)
        return
    yield searched(f"zone {zone.name}", flight.drone, 0.0, aloft, outside)
    yield searched(f"zone {zone.name} at home", flight.drone, 0.0, low, outside)


def separations(case: Case) -> Iterator[Worst]:
    """All pairs of the mission's drones, centre to centre, on the pads too."""
    needed = case.mission.rule("separation", SEPARATION)
    names = list(case.drones)
    for k, first in enumerate(names):
        for second in names[k + 1 :]:
            flown = [case.flights[name].dense for name in (first, second) if name in case.flights]
            t = np.unique(np.concatenate([[0.0, case.end], *flown]))

            def apart(t: Array, pair=(first, second)) -> Array:
                return np.linalg.norm(case.place(pair[0], t) - case.place(pair[1], t), axis=1)

            yield searched(f"separation from {second}", first, needed, [t], apart)
