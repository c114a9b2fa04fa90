"""From goal sets to a fleet's flight: times, limits, lights, separation, and what cannot be had."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import differences, places
from shotc.geom.separation import closest
from shotc.ir.fleet import FleetTrajectory, GoalIR, ShowIR
from shotc.ir.limits import Timing
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.show import Apart, Display, Easing
from shotc.ir.trajectory import TrajectoryIR
from shotc.show.assignment import AssignGoals
from shotc.show.separation import KeepApart
from shotc.show.solvers.qcqp import DerivativeBounds, overdraft
from shotc.show.splines import BoundSplines
from tests.support.few import few
from tests.support.fleet_scenes import (
    APART,
    LIMITS,
    animation,
    display,
    fleet,
    goals,
    grid,
    lattice,
    morph,
    picture,
)

CONTEXT = PassContext(seed=1)


def assigned(ir: GoalIR) -> ShowIR:
    done = AssignGoals().run(ir, CONTEXT)
    assert done.value is not None, done.diagnostics
    return done.value


def planned(ir: GoalIR) -> Outcome[TrajectoryIR]:
    bound = BoundSplines().run(assigned(ir), CONTEXT)
    assert bound.value is not None, bound.diagnostics
    return KeepApart().run(bound.value, CONTEXT)


def flown(ir: GoalIR) -> FleetTrajectory:
    done = planned(ir)
    assert done.value is not None, done.diagnostics
    return done.value.fleets[0]


def stat(ir: TrajectoryIR, name: str) -> float:
    return float(dict(ir.stats)[name])


def turning(count: int, frames: int, period: float, spacing: float) -> GoalIR:
    """Return a ball that turns and stretches, its goals in another order in every frame."""
    rng, base = np.random.default_rng(0), lattice(count, [0, 0, 0], spacing, 2)
    sets = []
    for k in range(frames):
        c, s, wide = np.cos(0.15 * k), np.sin(0.15 * k), 1 + 0.2 * np.sin(k / 3)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        sets.append(rng.permutation(base @ turn.T * [wide, wide**-0.3, 1.0] + [0, 0, 40]))
    return goals((fleet(count),), (display(animation(frames, period)),), {"show": [sets]})


def within_limits(flight: FleetTrajectory) -> bool:
    return bool((overdraft(flight.breaks, flight.coef, DerivativeBounds(LIMITS)) <= 0.0).all())


@pytest.mark.slow
def test_ball_cube_ring() -> None:
    ir = morph(60)
    flight = flown(ir)
    assert within_limits(flight)
    near = closest(flight.breaks, flight.coef, APART)
    assert near.proven >= APART.across
    frames = ir.fleets[0].frames
    assert [(s.picture, s.index) for s in flight.shown] == [(0, 0), (1, 0), (2, 0)]
    for shown, frame in zip(flight.shown, frames, strict=True):
        assert shown.end - shown.start == pytest.approx(2.0)
        for at in places(flight.breaks, flight.coef, np.array([shown.start, shown.end])).swapaxes(0, 1):
            assert same(at, frame.points)


def same(at: Array, points: Array) -> bool:
    """Tell whether these are the same points, in any order."""
    nearest = np.linalg.norm(at[:, None] - points[None], axis=2)
    return bool(nearest.min(axis=1).max() < 2e-6 and len(set(nearest.argmin(axis=1))) == len(at))


def test_the_phases_go_from_pads_to_pads() -> None:
    flight = flown(morph(20))
    assert [p.name for p in flight.phases] == ["takeoff", "transit", "shot", "return", "land"]
    assert flight.phases[0].start == 0.0
    assert flight.phases[-1].end == flight.breaks[-1]
    assert all(a.end == b.start for a, b in pairwise(flight.phases))
    ends = places(flight.breaks, flight.coef, np.array([0.0, flight.breaks[-1]]))
    assert np.allclose(ends[:, 0], grid(20))
    assert same(ends[:, 1], grid(20))
    for phase in (flight.phases[0], flight.phases[-1]):
        at = places(flight.breaks, flight.coef, np.linspace(phase.start, phase.end, 50))
        assert np.ptp(at[..., :2], axis=1).max() < 1e-9, "straight up and down"
    times = np.array([flight.phases[0].end, flight.phases[-1].start])
    assert places(flight.breaks, flight.coef, times)[..., 2] == pytest.approx(10.0)


def test_lights_are_dark_on_the_pads_and_lit_in_the_pictures() -> None:
    flight = flown(morph(20))
    lights = flight.lights
    assert (np.diff(lights.times) > 0.0).all()
    assert (lights.colors[:, [0, -1]] == 0).all()
    for shown in flight.shown:
        k = int(np.searchsorted(lights.times, shown.start))
        assert lights.times[k] == shown.start
        assert (lights.colors[:, k] == 255 - 20 * shown.picture).all()


def test_a_transition_and_a_start_are_kept_to() -> None:
    ir = morph(20)
    mission = ir.keyframes.mission
    shown = mission.displays[0]
    pictures = (shown.pictures[0], shown.pictures[1]._replace(transition=12.5), shown.pictures[2])
    ir = _with_display(ir, shown._replace(pictures=pictures, timing=Timing(start=60.0)))
    flight = flown(ir)
    assert flight.shown[0].start == pytest.approx(60.0, abs=1e-8)
    assert flight.shown[1].start - flight.shown[0].end == pytest.approx(12.5, abs=1e-8)
    assert within_limits(flight)


def _with_display(ir: GoalIR, shown: object) -> GoalIR:
    mission = ir.keyframes.mission._replace(displays=(shown,))  # type: ignore[arg-type]
    return GoalIR(ir.keyframes._replace(mission=mission), ir.fleets, ir.stats)


@pytest.mark.parametrize("easing", ["ease-in-out", "linear"])
def test_a_transition_that_is_too_short_names_the_shortest(easing: Easing) -> None:
    ir = morph(20)
    shown = ir.keyframes.mission.displays[0]

    def asked(seconds: float) -> Outcome[ShowIR]:
        second = shown.pictures[1]._replace(transition=seconds, easing=easing)
        pictures = (shown.pictures[0], second, shown.pictures[2])
        return AssignGoals().run(_with_display(ir, shown._replace(pictures=pictures)), CONTEXT)

    (found,) = asked(0.5).diagnostics
    assert found.code == "D080"
    assert found.message.endswith("with `easing: linear`" if easing == "linear" else "possible")
    shortest = float(found.help.split("transition: ")[1].split("`")[0])
    assert asked(shortest).value is not None
    assert asked(shortest - 0.02).value is None


def test_a_start_that_is_too_early_names_the_earliest() -> None:
    ir = morph(20)
    shown = ir.keyframes.mission.displays[0]
    done = AssignGoals().run(_with_display(ir, shown._replace(timing=Timing(start=3.0))), CONTEXT)
    (found,) = done.diagnostics
    assert found.code == "D081"
    earliest = float(found.help.split("start: ")[1].split(" s")[0])
    assert AssignGoals().run(_with_display(ir, shown._replace(timing=Timing(start=earliest))), CONTEXT).value


@pytest.mark.slow
@pytest.mark.parametrize("given", ["start", "at"])
def test_a_time_that_is_given_is_met_with_the_full_limits(given: str) -> None:
    """A pace of 0.5 leaves moves more time than they need, where their time is free."""
    ir = morph(20)
    calm = ir.keyframes.mission.displays[0]._replace(pace=0.5)

    def shown(display: Display, k: int) -> float:
        return assigned(_with_display(ir, display)).fleets[0].shown[k].start

    k, hurried = (0, shown(calm._replace(pace=1.0), 0)) if given == "start" else (1, shown(calm, 0) + 2.0)
    if given == "at":
        at_full = assigned(_with_display(ir, calm._replace(pace=1.0))).fleets[0].shown
        hurried += at_full[1].start - at_full[0].end
    time = 0.5 * (hurried + shown(calm, k))
    assert hurried + 0.5 < time < shown(calm, k) - 0.5
    first, second, third = calm.pictures
    timed = {
        "start": calm._replace(timing=Timing(start=time)),
        "at": calm._replace(pictures=(first, second._replace(at=time), third)),
    }[given]
    assert shown(timed, k) == pytest.approx(time, abs=1e-6)
    assert within_limits(flown(_with_display(ir, timed)))
    later = {
        "start": timed._replace(timing=Timing(start=hurried - 0.1)),
        "at": timed._replace(pictures=(first, second._replace(at=hurried - 0.1), third)),
    }[given]
    (found,) = AssignGoals().run(_with_display(ir, later), CONTEXT).diagnostics
    assert found.code == {"start": "D081", "at": "D124"}[given]
    assert f"{hurried:.2f}"[:-1] in found.message


def test_endurance_and_a_display_without_time() -> None:
    (found,) = AssignGoals().run(morph(20, endurance=30.0), CONTEXT).diagnostics
    assert found.code == "D082"
    points = lattice(20, [0, 0, 40], 1.5, 2)
    still = goals((fleet(20),), (display(picture(hold=0.0)),), {"show": [[points]]})
    (found,) = AssignGoals().run(still, CONTEXT).diagnostics
    assert found.code == "D083"


def test_an_animation_keeps_its_times_its_ends_and_its_limits() -> None:
    ir = turning(30, 20, 0.8, 2.0)
    flight = flown(ir)
    assert within_limits(flight)
    first, *rest = flight.shown
    assert [s.start - first.start for s in rest[:-1]] == pytest.approx([0.8 * (k + 2) for k in range(18)])
    assert flight.shown[-1].start - first.start == pytest.approx(0.8 * 21)
    assert flight.shown[-1].end - flight.shown[-1].start == pytest.approx(1.0)
    frames = ir.fleets[0].frames
    at = places(flight.breaks, flight.coef, np.array([first.start, flight.shown[-1].start]))
    assert same(at[:, 0], frames[0].points)
    assert same(at[:, 1], frames[-1].points)


@pytest.mark.slow
def test_a_jumpy_animation_is_bound_and_a_hopeless_one_is_told() -> None:
    base = lattice(8, [0, 0, 40], 4.0, 2)
    jumps = [base + np.array([(-1) ** k * 4.0, 0, 0]) for k in range(10)]
    ir = goals((fleet(8),), (display(animation(10, 0.7)),), {"show": [jumps]})
    show = assigned(ir)
    assert not within_limits(show.fleets[0])
    done = BoundSplines().run(show, CONTEXT).value
    assert done is not None
    assert within_limits(done.fleets[0])
    away = [base + np.array([10.0 * k, 0, 0]) for k in range(6)]
    ir = goals((fleet(8),), (display(animation(6, 0.7)),), {"show": [away]})
    (found,) = BoundSplines().run(assigned(ir), CONTEXT).diagnostics
    assert found.code == "D084"
    period = float(found.help.split("period: ")[1].split("`")[0])
    ir = goals((fleet(8),), (display(animation(6, period)),), {"show": [away]})
    assert BoundSplines().run(assigned(ir), CONTEXT).value is not None


@pytest.mark.parametrize(("period", "warned"), [(0.4, True), (8.0, False)])
def test_a_picture_that_limits_bend_is_told(period: float, warned: bool) -> None:
    base = lattice(8, [0, 0, 40], 4.0, 2)
    # Four metres there and back again, the ways as one: smoothness alone is a third of a metre off.
    sets = [base + np.array([min(k % 8, 8 - k % 8) * 1.0, 0, 0]) for k in range(17)]
    done = planned(goals((fleet(8),), (display(animation(17, period)),), {"show": [sets]}))
    assert done.value is not None
    flight, wanted = done.value.fleets[0], np.stack(sets)
    at = places(flight.breaks, flight.coef, np.array([s.start for s in flight.shown]))
    # Goals are 4 m apart, so the nearest one is a drone's own.
    worst = max(
        np.linalg.norm(at[:, k, None] - wanted[k], axis=2).min(axis=1).max() for k in range(len(sets))
    )
    assert stat(done.value, "fleet swarm off goals, largest m") == pytest.approx(worst, abs=1e-5)
    assert [d.code for d in done.diagnostics] == (["D088"] if warned else [])
    if warned:
        assert f"{worst:.2f} m" in done.diagnostics[0].message
        assert "period" in done.diagnostics[0].help


@pytest.mark.long
@pytest.mark.parametrize("shape", few(["ellipsoid", "cylinder"], ["ellipsoid"]))
def test_drones_matched_at_random_are_pushed_apart(shape: str, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    monkeypatch.setattr("shotc.show.assignment.order.matched", lambda starts, _: rng.permutation(len(starts)))
    apart = Apart(shape, 0.9, 1.4, 0.1)  # type: ignore[arg-type]
    points = [lattice(15, [0, 0, 40], 2.2, norm, apart) for norm in (2, np.inf)]
    shown = display(picture(transition=14.0), picture(transition=14.0), pace=0.5)
    ir = goals((fleet(15, apart=apart),), (shown,), {"show": [[p] for p in points]})
    before = assigned(ir).fleets[0]
    assert closest(before.breaks, before.coef, apart).attained < 0.9
    done = planned(ir)
    assert done.value is not None, done.diagnostics
    flight = done.value.fleets[0]
    assert closest(flight.breaks, flight.coef, apart).proven >= apart.across - 1e-6
    assert within_limits(flight)
    assert stat(done.value, "fleet swarm apart rounds") > 0
    assert stat(done.value, "fleet swarm apart shift") < 4.0


@pytest.mark.slow
def test_curved_ways_that_come_too_near_are_mended() -> None:
    done = planned(turning(60, 20, 1.0, 1.1))
    assert done.value is not None, done.diagnostics
    flight = done.value.fleets[0]
    assert closest(flight.breaks, flight.coef, APART).proven >= APART.across - 1e-6
    assert within_limits(flight)


@pytest.mark.slow
def test_places_that_are_too_near_are_told() -> None:
    points = lattice(20, [0, 0, 40], 0.8, 2)
    ir = goals((fleet(20),), (display(picture()),), {"show": [[points]]})
    (found, *_) = planned(ir).diagnostics
    assert found.code == "D085"
    assert "0.80 m" in found.message


@pytest.mark.slow
@pytest.mark.parametrize("wide", few([1.0, 3.0, 12.0], [1.0, 12.0]))
def test_pads_at_just_the_distance_that_is_kept_are_enough(wide: float) -> None:
    """The proof's gap goes with the distance, and so does what it may fall short of."""
    asked = Apart("ellipsoid", wide, wide, 0.0)
    pads = tuple(map(tuple, grid(9, wide).tolist()))
    points = lattice(9, [0, 0, 60], 1.5 * wide, 2, asked)
    done = planned(goals((fleet(9, apart=asked, pads=pads),), (display(picture()),), {"show": [[points]]}))
    assert done.value is not None, done.diagnostics
    flight = done.value.fleets[0]
    assert closest(flight.breaks, flight.coef, asked).attained == pytest.approx(wide, abs=2e-6 * wide)


@pytest.mark.slow
def test_two_fleets_that_meet_are_told() -> None:
    near = fleet(8, name="other", pads=tuple(map(tuple, (grid(8) + np.array([60.0, 0, 0])).tolist())))
    sets = {"show": [[lattice(8, [0, 0, 40], 2.0, 2)]], "next": [[lattice(8, [4, 0, 40], 2.0, 2)]]}
    first, second = display(picture()), display(picture(), id="next", fleet="other")
    (found,) = planned(goals((fleet(8), near), (first, second), sets)).diagnostics
    assert found.code == "D087"
    sets["next"] = [[lattice(8, [60, 0, 40], 2.0, 2)]]
    done = planned(goals((fleet(8), near), (first, second._replace(timing=Timing(after="show"))), sets))
    assert done.value is not None
    one, other = done.value.fleets
    assert other.shown[0].start >= one.shown[-1].end - 1e-9


def test_the_differences_of_a_flight_are_zero_where_it_stands() -> None:
    flight = flown(morph(5))
    rates = np.matmul(differences(flight.breaks, 1), flight.coef)
    for shown in flight.shown:
        at = places(flight.breaks, flight.coef, np.linspace(shown.start, shown.end, 9), 1)
        assert np.abs(at).max() < 1e-12
    assert np.isfinite(rates).all()
