"""What is claimed of fleets: values known by hand, dense samples, and every way to break a sound show."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, inf, nan

import numpy as np
import pytest
from scipy.interpolate import BSpline

from shotc.diag.registry import registry
from shotc.geom.fleet_pieces import FleetPieces, rates, velocity
from shotc.geom.fleet_spline import knots, pieces, places
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder, Prism, box
from shotc.geom.track import Track
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.limits import Timing
from shotc.ir.mission import MissionIR, Zone
from shotc.ir.phases import Phase
from shotc.ir.show import stricter
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.fleets.apart import separations
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.report import rule_of
from tests.support.records import replace
from tests.support.show_plans import PADS, RISE, STEP, display, fleet, flight, mission, show
from tests.support.verdicts import codes, verdict_on

SHOW = show()
FIELD = Prism(((-20.0, -20.0), (40.0, -20.0), (40.0, 60.0), (-20.0, 60.0)), 5.0, 50.0)


def claims(ir: TrajectoryIR) -> dict[str, Claim]:
    return {c.constraint: c for c in verdict_on(ir).certificate}


def with_flight(**changes: object) -> TrajectoryIR:
    return replace(SHOW, fleets=(replace(SHOW.fleets[0], **changes),))


def with_coef(edit: Callable[[np.ndarray], None]) -> TrajectoryIR:
    coef = SHOW.fleets[0].coef.copy()
    edit(coef)
    return with_flight(coef=coef)


def with_phase(index: int, **changes: object) -> TrajectoryIR:
    phases = list(SHOW.fleets[0].phases)
    phases[index] = replace(phases[index], **changes)
    return with_flight(phases=tuple(phases))


def with_shown(index: int, **changes: object) -> TrajectoryIR:
    shown = list(SHOW.fleets[0].shown)
    shown[index] = replace(shown[index], **changes)
    return with_flight(shown=tuple(shown))


def with_mission(**changes: object) -> TrajectoryIR:
    return show(mission(**changes))


def with_limits(**changes: float) -> TrajectoryIR:
    return with_mission(fleets=(fleet()._replace(limits=fleet().limits._replace(**changes)),))


def with_display(**changes: object) -> TrajectoryIR:
    return with_mission(displays=(display()._replace(**changes),))


def zone(keep: str, solid: object) -> MissionIR:
    return mission(zones=(Zone("extra", keep, solid, ("world", "zones", "extra")),))  # type: ignore[arg-type]


def test_a_sound_show_is_verified() -> None:
    verdict = verdict_on(SHOW)
    assert verdict.diagnostics == ()
    assert all(c.holds and c.hard and c.subject == "swarm" for c in verdict.certificate)
    assert {c.constraint for c in verdict.certificate} == {
        "distance from home", "rate at start and end", "endurance", "speed", "climb", "descent",
        "acceleration", "jerk", "ground clearance", "drift from the vertical", "depth below home",
        "times flown", "pictures left out", "pictures out of order", "lack of hold", "excess of hold",
        "display without a picture", "light off its colour", "dark lights of a picture",
        "light off its picture", "picture without lights", "picture off its place", "picture off its size",
        "error of transition", "drift at rest", "light between pictures", "separation",
    }  # fmt: skip
    for c in verdict.certificate:
        assert rule_of(c.constraint, mission()).code in registry()


def test_known_values() -> None:
    found = claims(SHOW)
    # Control points from above the pads to the first picture are twice (0, 10, 10) m apart, in steps of 2 s.
    assert found["speed"].worst == pytest.approx(5.0)
    assert found["climb"].worst == pytest.approx(5.0)
    assert found["climb"].time == pytest.approx(12.0)
    # On the way back they fall by 11, 0, 11 m: in the middle of a piece the velocity is 1/8, 6/8, 1/8 of its
    # three control points.
    assert found["descent"].worst == pytest.approx(0.75 * 11.0 / STEP)
    # The second difference of control points over step^2: (0, 10, 11) m at the joint.
    assert found["acceleration"].worst == pytest.approx(hypot(10.0, 11.0) / STEP**2)
    assert found["jerk"].worst == pytest.approx(2 * hypot(10.0, 11.0) / STEP**3)
    assert found["ground clearance"].worst == pytest.approx(RISE - 0.3)
    assert found["endurance"].worst == 46.0
    assert found["separation"].worst == pytest.approx(4.0, abs=1e-5)
    assert found["separation"].limit == pytest.approx(1.15)
    assert found["separation"].drones == ("swarm-1", "swarm-2")
    assert found["separation"].path == ("rules", "separation")


def test_one_drone_that_is_faster_is_named() -> None:
    def edit(coef: np.ndarray) -> None:
        coef[2, 17] += [3.0, 0.0, 0.0]

    found = claims(with_coef(edit))
    for name in ("acceleration", "jerk"):
        assert found[name].drones == ("swarm-3",)
    assert found["acceleration"].position is not None
    assert found["acceleration"].position[0] == pytest.approx(8.0, abs=3.0)


@pytest.mark.slow
def test_bounds_are_above_dense_samples_and_near() -> None:
    rng = np.random.default_rng(7)
    pads = tuple((3.0 * i, 0.0, 0.0) for i in range(30))
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.4, 2.0, 20))])
    coef = np.array(pads)[:, None] + rng.normal(scale=4.0, size=(30, 23, 3))
    end = float(breaks[-1])
    phases = (Phase("transit", None, 0.0, 1.0), Phase("shot", "globe", 1.0, end))
    track = replace(flight(fleet(pads)), breaks=breaks, coef=coef, phases=phases, shown=())
    found = claims(replace(show(mission(fleets=(fleet(pads),))), fleets=(track,)))
    t = np.linspace(0.0, end, 40_001)
    spline = BSpline(knots(breaks), np.moveaxis(coef, 1, 0), 3)
    v, a, j = (np.moveaxis(spline.derivative(n)(t[:-1]), 0, 1) for n in (1, 2, 3))
    sampled = {
        "speed": np.hypot(v[..., 0], v[..., 1]),
        "climb": v[..., 2],
        "descent": -v[..., 2],
        "acceleration": np.linalg.norm(a, axis=2),
        "jerk": np.linalg.norm(j, axis=2),
    }
    for name, values in sampled.items():
        worst, best = found[name].worst, float(values.max())
        assert best <= worst + 1e-9
        assert worst <= best + 2e-3 * max(1.0, best)
        who = int(np.unravel_index(int(values.argmax()), values.shape)[0])
        assert found[name].drones == (f"swarm-{who + 1:02d}",)


def test_pieces_and_derivatives_are_the_spline() -> None:
    rng = np.random.default_rng(1)
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.3, 2.0, 8))])
    coef = rng.normal(scale=10.0, size=(5, 11, 3))
    whole = FleetPieces(breaks[:-1], breaks[1:], pieces(breaks, coef))
    from_places = np.diff(whole.ctrl, axis=2) * 3 / np.diff(breaks)[:, None, None]
    np.testing.assert_allclose(velocity(breaks, coef).ctrl, from_places, atol=1e-10)
    np.testing.assert_allclose(rates(breaks, coef, 2), places(breaks, coef, breaks, 2), atol=1e-9)
    middles = 0.5 * (breaks[1:] + breaks[:-1])
    np.testing.assert_allclose(rates(breaks, coef, 3), places(breaks, coef, middles, 3), atol=1e-9)
    part = whole.between([(0.1, 0.2), (0.5, 4.0)])
    assert float(np.sum(part.high - part.low)) == pytest.approx(3.6)
    np.testing.assert_allclose(part.ctrl[:, :, 0], places(breaks, coef, part.low), atol=1e-12)
    np.testing.assert_allclose(part.ctrl[:, :, -1], places(breaks, coef, part.high), atol=1e-12)
    middle = part.ctrl @ np.eye(3)
    middle = (middle[:, :, 0] + 3 * middle[:, :, 1] + 3 * middle[:, :, 2] + middle[:, :, 3]) / 8
    np.testing.assert_allclose(middle, places(breaks, coef, 0.5 * (part.low + part.high)), atol=1e-12)
    assert not len(whole.between([(3.0, 3.0)]).low)


def test_zones_count_from_the_body_of_the_nearest_drone() -> None:
    # The pictures stand at y = 20, x = 0 to 12, z = 30 to 32.
    beside = show(zone("out", Cylinder((20.0, 20.0), 5.0, 0.0, 40.0)))
    found = claims(beside)["zone extra"]
    assert found.worst == pytest.approx(20.0 - 12.0 - 5.0 - 0.3, abs=1e-3)
    assert found.drones == ("swarm-4",)
    inside = show(zone("out", box((0.0, 20.0, 31.0), (2.0, 2.0, 4.0), 0.0)))
    assert codes(inside) == ["V007"]
    assert claims(inside)["zone extra"].drones == ("swarm-1",)
    within = claims(show(zone("in", FIELD)))["zone extra"]
    # East of the last pad are 28 m, above the second picture 18 m, below the rise 5 m.
    assert within.worst == pytest.approx(5.0 - 0.3)
    assert within.time is not None
    assert codes(show(zone("in", FIELD._replace(top=31.0)))) == ["V008"]


def test_far_fleets_are_proved_as_near_ones_are() -> None:
    pads = tuple((4.0 * i, 4.0 * j, 0.0) for i in range(12) for j in range(12))
    solid = Cylinder((100.0, 30.0), 3.0, 0.0, 50.0)
    asked = zone("out", solid)._replace(fleets=(fleet(pads),))
    found = claims(show(asked))["zone extra"]
    t = np.linspace(8.0, 38.0, 601)
    way = places(SHOW.fleets[0].breaks, flight(fleet(pads)).coef, t)
    away = np.hypot(way[..., 0] - 100.0, way[..., 1] - 30.0) - 3.0 - 0.3
    assert found.worst == pytest.approx(float(away.min()), abs=1e-2)
    assert found.worst <= float(away.min())
    assert found.drones == (f"swarm-{int(away.min(axis=1).argmin()) + 1:03d}",)


def test_pads_may_stand_near_a_solid_and_its_drones_no_nearer() -> None:
    wall = box((0.0, -1.2, 0.5), (4.0, 2.0, 1.0), 0.0)  # 0.2 m from the first pad; bodies reach 0.3 m
    found = claims(show(zone("out", wall)))
    assert found["zone extra at home"].worst == pytest.approx(0.0, abs=1e-6)
    assert found["zone extra at home"].drones == ("swarm-1",)
    assert codes(show(zone("out", wall))) == []
    balcony = box((0.0, -1.1, 5.0), (4.0, 2.0, 1.0), 0.0)  # 0.1 m from its vertical
    assert codes(show(zone("out", balcony))) == ["V007"]


def test_targets_that_stand_and_that_move() -> None:
    mast = Target("mast", (20.0, 20.0, 20.0), CylinderShape(5.0, 40.0), ("targets", "mast"))
    standing = claims(with_mission(targets=(mast,)))["target mast"]
    assert standing.worst == pytest.approx(20.0 - 12.0 - 5.0 - 0.3, abs=1e-3)
    # A balloon at 31 m that comes along y = 20 from the east and stands 10 m from the last drone.
    track = Track((0.0, 16.0), ((80.0, 20.0, 31.0), (22.0, 20.0, 31.0)))
    balloon = Target("balloon", (80.0, 20.0, 31.0), CylinderShape(2.0, 6.0), ("targets", "balloon"), track)
    moving = claims(with_mission(targets=(balloon,)))["target balloon"]
    assert moving.worst == pytest.approx(22.0 - 12.0 - 2.0 - 0.3, abs=1e-3)
    assert moving.drones == ("swarm-4",)
    assert moving.time is not None
    assert moving.time >= 16.0 - 1e-3
    nearer = track._replace(points=(track.points[0], (14.5, 20.0, 31.0)))
    assert codes(with_mission(targets=(balloon._replace(track=nearer),))) == ["V010"]


def test_moving_targets_agree_with_dense_samples() -> None:
    rng = np.random.default_rng(3)
    times = tuple(np.linspace(0.0, 46.0, 60).tolist())
    points = tuple(
        map(tuple, np.cumsum(rng.normal(scale=1.0, size=(60, 3)), axis=0) + np.array([6.0, 35.0, 31.0]))
    )
    track = Track(times, points)  # type: ignore[arg-type]
    bird = Target("bird", points[0], CylinderShape(0.5, 1.0), ("targets", "bird"), track)  # type: ignore[arg-type]
    found = claims(with_mission(targets=(bird,)))["target bird"]
    t = np.linspace(8.0, 38.0, 30_001)
    flown = places(SHOW.fleets[0].breaks, SHOW.fleets[0].coef, t)
    at = np.stack([np.interp(t, times, np.array(points)[:, k]) for k in range(3)], axis=1)
    flat = np.maximum(np.hypot(*np.moveaxis(flown - at, 2, 0)[:2]) - 0.5, 0.0)
    high = np.maximum(np.abs((flown - at)[..., 2]) - 0.5, 0.0)
    nearest = float(np.hypot(flat, high).min()) - 0.3
    assert found.worst <= nearest + 1e-9
    assert found.worst == pytest.approx(nearest, abs=5e-3)


def test_separation_is_stretched_and_between_fleets_the_stricter_counts() -> None:
    # One above the other, 3 m: 3 * 1.15 / 2.15 in the stretched metric.
    pads = ((0.0, 0.0, 0.0), (0.0, 0.0, 3.0))
    ir = show(mission(fleets=(fleet(pads),)))
    assert claims(ir)["separation"].worst == pytest.approx(3.0 * 1.15 / 2.15, rel=1e-5)
    near = show(mission(fleets=(fleet(((0.0, 0.0, 0.0), (0.0, 0.0, 2.0))),)))
    assert codes(near) == ["V022"]
    (told,) = verdict_on(near).diagnostics
    assert "swarm-1 and swarm-2 of swarm" in told.message
    assert told.help is not None
    assert "ask for 0.080 m less `separation`" in told.help
    other = fleet(tuple((x + 2.0, y, z) for x, y, z in PADS), "crowd")
    wide = other._replace(apart=other.apart._replace(shape="cylinder", horizontal=1.5))
    both = mission(fleets=(fleet(), wide), displays=(display(), display("ring", "crowd", 1)))
    found = next(c for c in verdict_on(show(both)).certificate if c.constraint == "separation from crowd")
    assert (found.subject, found.limit) == ("swarm", pytest.approx(1.65))
    assert found.worst == pytest.approx(2.0, abs=1e-5)
    assert [name.rstrip("1234") for name in found.drones] == ["swarm-", "crowd-"]
    assert stricter(fleet().apart, wide.apart).shape == "cylinder"
    assert "separation" not in claims(show(mission(fleets=(fleet(PADS[:1]),))))


def test_time_on_the_pad_is_no_flight() -> None:
    coef, breaks = SHOW.fleets[0].coef, SHOW.fleets[0].breaks
    waits = np.concatenate([coef[:, :1]] * 5 + [coef] + [coef[:, -1:]] * 3, axis=1)
    longer = STEP * np.arange(waits.shape[1] - 2)
    moved = [replace(p, start=p.start + 10, end=p.end + 10) for p in SHOW.fleets[0].phases]
    moved[0], moved[-1] = replace(moved[0], start=0.0), replace(moved[-1], end=float(longer[-1]))
    shown = tuple(replace(s, start=s.start + 10, end=s.end + 10) for s in SHOW.fleets[0].shown)
    lights = replace(SHOW.fleets[0].lights, times=SHOW.fleets[0].lights.times + 10)
    ir = with_flight(coef=waits, breaks=longer, phases=tuple(moved), shown=shown, lights=lights)
    assert codes(ir) == []
    assert claims(ir)["endurance"].worst == float(breaks[-1])


def test_a_fleet_may_land_on_its_pads_in_another_order() -> None:
    def exchange(coef: np.ndarray) -> None:
        coef[[0, 3], 19:] = coef[[3, 0], 19:]
        coef[0, 17:19] = (6.0, 10.0, 27.0)
        coef[3, 17:19] = (6.0, 10.0, 15.0)

    ir = with_coef(exchange)
    assert not {"V012", "V017", "V022"} & set(codes(ir))
    assert claims(ir)["distance from home"].worst == pytest.approx(0.0, abs=1e-9)
    post = show(zone("out", Cylinder((12.6, 0.0), 0.5, 0.0, 2.0)))  # 0.1 m from the last pad
    moved = replace(post, fleets=ir.fleets)
    assert claims(moved)["zone extra at home"].holds
    assert "V022" in codes(with_coef(lambda c: c.__setitem__((0, slice(19, None)), c[3, 19:])))


def lift(coef: np.ndarray) -> None:
    coef[1, 7, 2] += 30.0


BROKEN: list[tuple[str, TrajectoryIR, str]] = [
    ("speed", with_limits(speed=4.9), "V001"),
    ("climb", with_limits(climb=4.9), "V001"),
    ("descent", with_limits(descent=4.1), "V001"),
    ("acceleration", with_limits(acceleration=3.7), "V002"),
    ("jerk", with_limits(jerk=3.7), "V003"),
    ("tilt", with_limits(tilt=0.2), "V053"),
    ("thrust", with_limits(thrust_to_weight=1.05), "V054"),
    ("endurance", with_mission(fleets=(fleet()._replace(endurance=45.0),)), "V013"),
    ("a control point", with_coef(lift), "V001"),
    ("a start off its pad", with_coef(lambda c: c.__setitem__((0, slice(0, 3), 0), 0.5)), "V012"),
    ("a start in motion", with_coef(lambda c: c.__setitem__((0, 0, 2), -0.01)), "V012"),
    ("a slanted take-off", with_coef(lambda c: c.__setitem__((3, 4, 1), 0.01)), "V017"),
    ("a dive below the pad", with_coef(lambda c: c.__setitem__((3, 2, 2), -0.1)), "V017"),
    ("two drones in one place", with_coef(lambda c: c.__setitem__((1, slice(8, 12)), c[0, 8])), "V022"),
    ("a picture that drifts", with_coef(lambda c: c.__setitem__((0, 10, 0), 0.2)), "V016"),
    ("low flight", with_mission(rules=mission().rules._replace(ground_clearance=9.8)), "V009"),
    ("an end of phases", with_phase(4, end=45.0), "V014"),
    ("a gap in phases", with_phase(2, end=27.0), "V014"),
    ("no phases", with_flight(phases=()), "V014"),
    ("a phase of no display", with_phase(2, shot="other"), "V014"),
    ("a shot without a name", with_phase(2, shot=None), "V014"),
    ("a display that is a transit", with_phase(2, name="transit", shot=None), "V015"),
    ("time that is none", with_shown(0, start=nan), "V014"),
    ("a late start", with_flight(breaks=SHOW.fleets[0].breaks + 1.0), "V014"),
    ("a moment's piece", with_flight(breaks=np.r_[0.0, 1e-7, SHOW.fleets[0].breaks[2:]]), "V014"),
    ("too few control points", with_flight(coef=SHOW.fleets[0].coef[:, :-1]), "V014"),
    ("too few drones", with_flight(coef=SHOW.fleets[0].coef[:-1]), "V014"),
    ("places beyond the world", with_flight(coef=SHOW.fleets[0].coef * 1e6), "V014"),
    ("places that are none", with_coef(lambda c: c.__setitem__((0, 5, 0), inf)), "V014"),
    ("an unknown fleet", with_flight(fleet="crowd"), "V014"),
    ("no flight at all", replace(SHOW, fleets=()), "V015"),
    ("a picture left out", with_flight(shown=SHOW.fleets[0].shown[:1]), "V015"),
    ("a picture too many", with_shown(1, picture=2), "V015"),
    ("pictures in another order", with_flight(shown=SHOW.fleets[0].shown[::-1]), "V015"),
    ("a picture before its display", with_shown(0, start=15.0), "V015"),
    ("a hold cut short", with_shown(0, end=19.0), "V015"),
    ("a hold that goes on", with_shown(0, end=21.0), "V015"),
    ("another transition", with_shown(1, start=25.0), "V015"),
    ("another start", with_display(timing=Timing(start=15.0)), "V015"),
    ("another duration", with_display(timing=Timing(duration=13.0)), "V015"),
    ("another order of displays", with_display(timing=Timing(after="globe")), "V015"),
    ("upright flight without phases", with_phase(0, name="transit"), "V009"),
]  # fmt: skip


@pytest.mark.parametrize(("ir", "code"), [b[1:] for b in BROKEN], ids=[b[0] for b in BROKEN])
def test_what_is_broken_is_found(ir: TrajectoryIR, code: str) -> None:
    verdict = verdict_on(ir)
    assert code in {d.code for d in verdict.diagnostics}
    assert all((d.code in registry() and d.labels) or d.code == "V014" for d in verdict.diagnostics)


def test_more_time_is_advised_where_a_display_moves_too_fast() -> None:
    ir = with_coef(lambda c: c.__setitem__((slice(None), slice(13, 17), 2), 60.0))
    told = next(d for d in verdict_on(ir).diagnostics if "climb" in d.message)
    assert told.help is not None
    assert told.help.startswith("give the moves of shot `globe` ")
    assert "raise `limits.climb`" in told.help


def test_times_that_are_met() -> None:
    assert codes(with_display(timing=Timing(start=16.0, duration=12.0))) == []


def test_a_fleet_that_is_not_there_has_no_sound_structure() -> None:
    (told,) = verdict_on(with_flight(fleet="crowd")).diagnostics
    assert "crowd" in told.message


def test_the_worst_place_and_time_are_the_drone_s() -> None:
    for c in verdict_on(SHOW).certificate:
        if c.time is not None and len(c.drones) == 1 and c.position is not None:
            track: FleetTrajectory = SHOW.fleets[0]
            drone = int(c.drones[0].removeprefix("swarm-")) - 1
            at = places(track.breaks, track.coef, np.array([c.time]))[drone, 0]
            np.testing.assert_allclose(at, c.position, atol=1e-9)


def test_two_drones_on_near_pads_take_off_in_layers_and_are_proved_in_the_air_and_on_their_pads() -> None:
    near = fleet(((0.0, 0.0, 0.0), (0.7, 0.0, 0.0)))
    up = flight(near)
    first, last = (np.repeat(up.coef[:, end], 3, axis=1) for end in (slice(None, 1), slice(-1, None)))
    coef = np.concatenate([first, up.coef, last], axis=1)
    stands = replace(up, breaks=STEP * np.arange(coef.shape[1] - 2), coef=coef)
    found = separations([FleetFlight.of(mission(fleets=(near,)), stands)])
    assert {claim.constraint: claim.worst for claim in found} == {
        "separation in the air": pytest.approx(0.7, abs=1e-6),
        "separation on pads": pytest.approx(0.7, abs=1e-6),
    }


def test_a_drone_that_passes_another_on_its_pad_is_found() -> None:
    """The first goes straight from (0, 0) to (0.4, 0.5) beside the second at (0.7, 0), which stands."""
    near = fleet(((0.0, 0.0, 0.0), (0.7, 0.0, 0.0)))
    moves = np.repeat([near.pads[0], (0.4, 0.0, 0.5), (0.0, 0.0, 9.0)], 4, axis=0)
    coef = np.stack([moves, np.repeat([near.pads[1]], len(moves), axis=0)])
    flown = replace(flight(near), breaks=STEP * np.arange(coef.shape[1] - 2), coef=coef)
    found = {c.constraint: c for c in separations([FleetFlight.of(mission(fleets=(near,)), flown)])}
    assert found["separation on pads"].worst == pytest.approx(0.35 / np.hypot(0.4, 0.5), abs=1e-5)
