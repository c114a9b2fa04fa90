"""Claims on all flights of a fleet together, with a clock; each flight has its own breaks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import inf, isfinite

import numpy as np

from shotc.flightfiles.clocked import ClockedFlight, leaves
from shotc.flightfiles.judge import FileClaim, to_tolerance
from shotc.flightfiles.moves import (
    FlightPieces,
    LimitFinding,
    accelerations,
    bag_of,
    bagged,
    beyond,
    speeds,
    who,
)
from shotc.geom.bernstein import Array
from shotc.geom.meetings import closest_of
from shotc.geom.pieces import Pieces, cut, join
from shotc.geom.proof import ProvedExtreme, inf_channel, inf_distance, norm, sup_channel, sup_outside
from shotc.geom.solid_arrays.points import separation, signed_distance
from shotc.geom.solids import Solid, convex_parts
from shotc.geom.surface.distance import SurfaceBound
from shotc.geom.surface.distance import inf_distance as surface_distance
from shotc.geom.surface.ground import NoGround, height_at
from shotc.geom.surface.height import inf_height, sup_height
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.origin import KeyPath
from shotc.ir.rules import Rules
from shotc.ir.sampling import beside
from shotc.ir.show import Apart, Fleet
from shotc.ir.target import Target
from shotc.ir.terrain import Terrain
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import Limit, WorstValue, gap, held, less
from shotc.passes.verify.fleets.space import nearest
from shotc.planning.take_off import bodies_of, take_off_of

Span = tuple[float, float]

AT_PAD_M = 0.05
"""Metres from the pad, within which a flight begins and ends on it."""


@dataclass(frozen=True, slots=True, eq=False)
class Swarm:
    """A fleet's flights in the order of its pads, with their pieces, divided into free and vertical ones.

    pads : positions of the pads, W, metres, shape (n, 3)
    """

    mission: MissionIR
    fleet: Fleet
    flights: tuple[ClockedFlight, ...]
    whole: FlightPieces
    free: FlightPieces
    upright: FlightPieces
    pads: Array

    @staticmethod
    def of(mission: MissionIR, fleet: Fleet, flights: tuple[ClockedFlight, ...]) -> Swarm:
        """Return the flights of a fleet's drones."""
        pads = np.array(fleet.pads)
        free: list[Pieces] = []
        upright: list[Pieces] = []
        for flight, pad in zip(flights, pads, strict=True):
            curve = flight.curve
            up, down = leaves(flight.curve, pad, pads)
            free.append(cut(curve, up, down))
            upright.append(join([cut(curve, curve.start, up), cut(curve, down, curve.end)]))
        return Swarm(mission, fleet, flights, bag_of(flights), bagged(free), bagged(upright), pads)


def judged(swarm: Swarm) -> Iterator[FileClaim]:
    """Yield all claims on a fleet: one for each constraint, with the drone nearest to the limit."""
    fleet, limits = swarm.fleet, swarm.fleet.limits
    yield from _pads(swarm)
    for move in (
        *speeds(swarm.flights, swarm.whole, limits, fleet.path),
        *accelerations(swarm.flights, limits, fleet.path),
    ):
        yield moved(fleet.name, swarm.flights, move, fleet=True)
    yield from _space(swarm)
    if len(swarm.flights) > 1:
        yield from _separation(swarm)


def moved(
    subject: str, flights: Sequence[ClockedFlight], move: LimitFinding, *, fleet: bool = False
) -> FileClaim:
    """Return a claim on motion; it holds up to the file's uncertainty."""
    flight, time = flights[move.owner], move.worst.time or 0.0
    x, y, z = flight.curve(time).tolist()
    worst = WorstValue(move.worst.value, move.worst.time, move.worst.method, (x, y, z))
    claim = held(subject, move.limit, worst, (flight.name,) if fleet else ())
    open_ = {move.limit.unit: move.leeway} if not beyond(move) else {}
    return FileClaim(to_tolerance(claim, open_), flight.at(time), when(flight, time))


def when(flight: ClockedFlight, time: float) -> tuple[str, ...]:
    """Return the notes on a time, and on the place in a file that has no lines."""
    element = () if flight.rows is not None else (f"in {flight.at(time).text}",)
    return (f"at t = {time:.3f} s", *element)


def _file_claim(swarm: Swarm, limit: Limit, bound: ProvedExtreme, owner: int) -> FileClaim:
    flight = swarm.flights[owner]
    x, y, z = flight.curve(bound.at).tolist()
    claim = held(
        swarm.fleet.name, limit, WorstValue(bound.proven, bound.at, "bounded", (x, y, z)), (flight.name,)
    )
    leeway = max(each.leeway.place for each in swarm.flights)
    return FileClaim(to_tolerance(claim, {"m": leeway}), flight.at(bound.at), when(flight, bound.at))


def _pads(swarm: Swarm) -> Iterator[FileClaim]:
    """Yield the claims on start and landing pads, and on the endurance."""
    fleet = swarm.fleet
    ends = [(0.0, f.curve.ctrl[0, 0], k) for k, f in enumerate(swarm.flights)]
    if fleet.returns == "own":
        ends += [(f.curve.end, f.curve.ctrl[-1, -1], k) for k, f in enumerate(swarm.flights)]
    distances = [float(norm(place - swarm.pads[k])) for _, place, k in ends]
    worst = int(np.argmax(distances))
    time, _, k = ends[worst]
    home = Limit("distance from home", AT_PAD_M, "m", (*fleet.path, "layout"))
    yield _file_claim(swarm, home, ProvedExtreme(distances[worst], distances[worst], time), k)
    airborne = np.array([down - up for up, down in map(_moving, swarm.flights)])
    k = int(np.argmax(airborne))
    endurance = Limit("endurance", fleet.endurance, "s", (*fleet.path, "endurance"))
    yield _file_claim(
        swarm, endurance, ProvedExtreme(float(airborne[k]), float(airborne[k]), swarm.flights[k].curve.end), k
    )


def _moving(flight: ClockedFlight, least: float = 0.0) -> Span:
    """Return the times at which a drone leaves its first position and reaches its last one, seconds.

    least : smallest motion that counts, metres
    """
    curve = flight.curve
    moves = np.asarray((np.abs(curve.ctrl - curve.ctrl[:, :1]) > least).any(axis=(1, 2)))
    if not moves.any():
        return curve.end, curve.end
    first, last = int(np.argmax(moves)), len(moves) - int(np.argmax(moves[::-1]))
    return float(curve.breaks[first]), float(curve.breaks[last])


def _aloft(swarm: Swarm) -> Array:
    """Return the times between which each drone is off its pads, shape (n, 2); infinite if it ends elsewhere.

    A drone stands on a piece of its flight if it moves by less than the file's uncertainty.
    """
    spans = []
    for flight in swarm.flights:
        ends = (flight.curve.ctrl[0, 0], flight.curve.ctrl[-1, -1])
        on_pad = [float(norm(swarm.pads - end).min()) <= AT_PAD_M for end in ends]
        up, down = _moving(flight, flight.leeway.place)
        spans.append((up if on_pad[0] else -inf, down if on_pad[1] else inf))
    return np.array(spans)


def _space(swarm: Swarm) -> Iterator[FileClaim]:
    """Yield the claims on zones, ground, heights, and standing and moving targets."""
    mission, rules = swarm.mission, swarm.mission.rules
    for zone in mission.zones:
        name = f"zone {zone.name}"
        if zone.keep == "out":
            yield from _keep_out(swarm, Limit(name, 0.0, "m", zone.path, upper=False), zone.solid)
        else:
            yield _keep_in(swarm, Limit(name, 0.0, "m", zone.path, upper=False), zone.solid)
    yield from _ground(swarm) if mission.terrain is None else _terrain(swarm, mission.terrain)
    for mesh in mission.meshes:
        yield from _beside(swarm, mesh)
    for target in mission.targets:
        path: KeyPath = ("rules", "target_clearance")
        limit = Limit(f"target {target.name}", rules.target_clearance, "m", path, upper=False)
        if target.track is None:
            yield from _keep_out(swarm, limit, target.kept_clear)
        else:
            yield _keep_from(swarm, limit, target)


def _ground(swarm: Swarm) -> Iterator[FileClaim]:
    """Yield the claims on the height above flat ground."""
    free, rules, radius = swarm.free, swarm.mission.rules, swarm.fleet.radius
    if len(free.pieces):
        low = inf_channel(free.pieces, 2, gap(rules.ground_clearance + radius))
        owner = who(free, low.at, lambda p: p[:, 2], upper=False)
        yield _file_claim(swarm, _clearance(rules), less(low, radius), owner)
    most = rules.max_height
    if most is not None and isfinite(most):
        high = sup_channel(swarm.whole.pieces, 2, gap(most))
        owner = who(swarm.whole, high.at, lambda p: p[:, 2], upper=True)
        yield _file_claim(
            swarm, Limit("height above ground", most, "m", ("rules", "max_height")), high, owner
        )


def _clearance(rules: Rules) -> Limit:
    return Limit("ground clearance", rules.ground_clearance, "m", ("rules", "ground_clearance"), upper=False)


def _terrain(swarm: Swarm, terrain: Terrain) -> Iterator[FileClaim]:
    """Yield the claims on the height above terrain and the body's distance from it; none holds outside it."""
    free, rules, radius, ground = swarm.free, swarm.mission.rules, swarm.fleet.radius, terrain.ground

    def above(p: Array) -> Array:
        return p[:, 2] - height_at(ground, p[:, :2])

    def file_claim(limit: Limit, bound: SurfaceBound | NoGround, bag: FlightPieces, by: float) -> FileClaim:
        if isinstance(bound, SurfaceBound):
            return _file_claim(swarm, limit, less(bound, by), int(bag.owner[bound.piece]))
        never = inf if limit.upper else -inf
        outside = who(bag, bound.at, lambda p: np.nan_to_num(above(p), nan=never), upper=limit.upper)
        return _file_claim(swarm, limit, ProvedExtreme(never, never, bound.at), outside)

    if len(free.pieces):
        low = inf_height(free.pieces, ground, gap(rules.ground_clearance + radius))
        yield file_claim(_clearance(rules), low, free, radius)
        near = surface_distance(free.pieces, ground.surface, gap(radius))
        yield file_claim(
            Limit("distance from terrain", 0.0, "m", terrain.path, upper=False), near, free, radius
        )
    most = rules.max_height
    if most is not None and isfinite(most) and len(swarm.whole.pieces):
        high = sup_height(swarm.whole.pieces, ground, gap(most))
        yield file_claim(
            Limit("height above ground", most, "m", ("rules", "max_height")), high, swarm.whole, 0.0
        )


def _beside(swarm: Swarm, mesh: ObstacleMesh) -> Iterator[FileClaim]:
    """Yield the claims on the distance from a scene or buildings; over its pad a body may be as near as its
    pad.
    """
    least, body = swarm.mission.rules.obstacle_clearance, swarm.fleet.radius + mesh.spacing
    name, pads = f"distance from {mesh.kind}", mesh.signed_distance(swarm.pads)
    for bag, at_home in ((swarm.free, False), (swarm.upright, True)):
        if not len(bag.pieces):
            continue
        worst, owner = ProvedExtreme(inf, inf, 0.0), 0
        for k in np.unique(bag.owner):
            allowance = min(body, float(abs(pads[k]))) if at_home else body
            bound = surface_distance(bag.pieces.pick(bag.owner == k), mesh.surface, gap(allowance + least))
            lack = less(
                ProvedExtreme(-bound.attained, -bound.attained, bound.at) if pads[k] < 0 else bound, allowance
            )
            if lack.proven < worst.proven:
                worst, owner = lack, int(k)
        limit = Limit(name, least, "m", ("rules", "obstacle_clearance"), upper=False)
        own = Limit(f"{name} at home", 0.0, "m", mesh.path, upper=False)
        yield _file_claim(swarm, own if at_home else limit, worst, owner)


def _keep_out(swarm: Swarm, limit: Limit, solid: Solid) -> Iterator[FileClaim]:
    free, radius = swarm.free, swarm.fleet.radius
    distance_at: Callable[[Array], Array] = lambda p: signed_distance(solid, p)  # noqa: E731
    if len(free.pieces):
        bound = nearest(free.pieces, solid, gap(radius + limit.value))
        yield _file_claim(swarm, limit, less(bound, radius), who(free, bound.at, distance_at, upper=False))
    upright = swarm.upright
    if not len(upright.pieces):
        return
    # On the vertical over its pad, a body may be as near as it is on the pad.
    near = np.minimum(
        radius, np.min([separation(part, swarm.pads)[0] for part in convex_parts(solid)], axis=0)
    )
    worst, owner = ProvedExtreme(np.inf, np.inf, 0.0), 0
    clear = np.isin(upright.owner, np.flatnonzero(near >= radius))
    if clear.any():
        some = FlightPieces(upright.pieces.pick(clear), upright.owner[clear])
        worst = less(nearest(some.pieces, solid, gap(radius)), radius)
        owner = who(some, worst.at, distance_at, upper=False)
    for k in np.flatnonzero(near < radius):
        bound = less(
            inf_distance(upright.pieces.pick(upright.owner == k), solid, gap(near[k])), float(near[k])
        )
        if bound.proven < worst.proven:
            worst, owner = bound, int(k)
    own = Limit(f"{limit.constraint} at home", 0.0, "m", limit.path, upper=False)
    yield _file_claim(swarm, own, worst, owner)


def _keep_in(swarm: Swarm, limit: Limit, solid: Solid) -> FileClaim:
    worst, owner = ProvedExtreme(-np.inf, -np.inf, 0.0), 0
    for bag, floor in ((swarm.free, True), (swarm.upright, False)):
        if len(bag.pieces):
            bound = sup_outside(bag.pieces, solid, gap(-swarm.fleet.radius), floor=floor)
            if bound.proven > worst.proven:
                within = solid if floor else solid._replace(bottom=-np.inf)
                worst = bound
                owner = who(bag, bound.at, lambda p, s=within: -signed_distance(s, p), upper=False)
    margin = ProvedExtreme(-worst.proven, -worst.attained, worst.at)
    return _file_claim(swarm, limit, less(margin, swarm.fleet.radius), owner)


def _keep_from(swarm: Swarm, limit: Limit, target: Target) -> FileClaim:
    """Return the claim on the distance from a moving target, the worst of all drones."""
    radius = swarm.fleet.radius
    worst, owner = ProvedExtreme(np.inf, np.inf, 0.0), 0
    for k, flight in enumerate(swarm.flights):
        up, down = leaves(flight.curve, swarm.pads[k], swarm.pads)
        if down > up:
            seen = beside(flight.curve, target)
            bound = inf_distance(cut(seen, up, down), target.kept_clear, gap(radius + limit.value))
            if bound.proven < worst.proven:
                worst, owner = bound, k
    return _file_claim(swarm, limit, less(worst, radius), owner)


def _separation(swarm: Swarm) -> Iterator[FileClaim]:
    """Yield the claims on separation; for a fleet that takes off in layers on drones in the air and on
    bodies.
    """
    fleet = swarm.fleet
    if not take_off_of(fleet).layered:
        yield from _separation_claim(swarm, "separation", fleet.apart)
        return
    yield from _separation_claim(swarm, "separation in the air", fleet.apart, _aloft(swarm))
    yield from _separation_claim(swarm, "separation on pads", bodies_of(fleet))


def _separation_claim(
    swarm: Swarm, name: str, apart: Apart, spans: Array | None = None
) -> Iterator[FileClaim]:
    fleet = swarm.fleet
    closest = closest_of([flight.curve for flight in swarm.flights], apart, spans=spans)
    if not isfinite(closest.proven):
        return  # no two drones are in the air at once
    own = (*fleet.path, "separation")
    origins = swarm.mission.origins
    path: KeyPath = own if own in origins.keys or own in origins.values else ("rules", "separation")
    limit = Limit(name, apart.across, "m", path, upper=False)
    pair = (swarm.flights[closest.first], swarm.flights[closest.second])
    worst = WorstValue(closest.proven, closest.time, "bounded", closest.position)
    claim: Claim = held(fleet.name, limit, worst, (pair[0].name, pair[1].name))
    leeway = sum(flight.leeway.place for flight in pair)
    yield FileClaim(to_tolerance(claim, {"m": leeway}), pair[0].at(closest.time), when(pair[0], closest.time))
