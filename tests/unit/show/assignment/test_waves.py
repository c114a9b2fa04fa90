"""Waves of departure: who sets out when, the proof that all stay apart, what is told where they do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.effects import Way
from shotc.ir.fleet import FleetTrajectory, ShowIR
from shotc.ir.passes import PassContext
from shotc.ir.show import Picture, Wave
from shotc.show.assignment import AssignGoals
from shotc.show.assignment.over import MoveSurroundings
from shotc.show.assignment.score import FlightScore
from shotc.show.assignment.swell import Heights
from shotc.show.assignment.waves import Waves, departures
from shotc.show.goals.room import room_of
from shotc.show.separation import KeepApart
from shotc.show.solvers.match import matched
from shotc.show.splines import BoundSplines
from tests.support.few import examples
from tests.support.fleet_scenes import APART, display, fleet, goals, grid, lattice, picture
from tests.support.verdicts import verdict_on

CONTEXT = PassContext(seed=1)
STRETCH = np.array([1.0, 1.0, APART.across / APART.upright])
CORNERS = np.array([[x, y, z] for x in (-2.0, 2.0) for y in (-3.0, 3.0) for z in (9.0, 14.0)])


def wave(time: float = 4.0, along: Way = "right", **changes: object) -> Wave:
    return Wave(time, along, "goal", None)._replace(**changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("along", "viewpoint", "axis", "sign"),
    [
        ("right", None, 0, 1.0),
        ("left", (0.0, -80.0, 2.0), 0, -1.0),
        ("right", (0.0, 80.0, 2.0), 0, -1.0),  # seen from the north, west is right
        ("away", (0.0, -80.0, 2.0), 1, 1.0),
        ("north", None, 1, 1.0),
        ("up", None, 2, 1.0),
        ("down", None, 2, -1.0),
    ],
)
@pytest.mark.parametrize("by", ["start", "goal"])
def test_drones_set_out_in_the_order_of_their_places(
    along: Way, viewpoint: tuple[float, float, float] | None, axis: int, sign: float, by: str
) -> None:
    elsewhere = np.random.default_rng(3).normal(size=CORNERS.shape)
    ends = (CORNERS, elsewhere) if by == "start" else (elsewhere, CORNERS)
    found = departures(wave(4.0, along, by=by), viewpoint, ends)
    order = sign * CORNERS[:, axis]
    assert found == pytest.approx(4.0 * (order - order.min()) / np.ptp(order))


def test_a_wave_goes_out_from_a_middle_and_by_numbers() -> None:
    line = np.array([[x, 0.0, 30.0] for x in (0.0, 1.0, 2.0, 4.0)])
    ends = line[::-1], line
    out = wave(8.0, "out", center=(0.0, 0.0, 30.0))
    assert departures(out, None, ends) == pytest.approx([0.0, 2.0, 4.0, 8.0])
    assert departures(out._replace(along="in"), None, ends) == pytest.approx([8.0, 6.0, 4.0, 0.0])
    assert departures(wave(6.0, "index"), None, ends) == pytest.approx([0.0, 2.0, 4.0, 6.0])
    assert departures(wave(6.0, "up"), None, ends) is None
    assert departures(wave(6.0, "index"), None, (line[:1], line[:1])) is None


def asked(**changes: object) -> Picture:
    return picture(path=("shots", 0, "frames", 1), **changes)


def least_sampled(ends: tuple[Array, Array], waves: Waves, drawn: Picture) -> float:
    """Return how near two come at 300 instants of the move that is planned, heights stretched, metres."""
    move = waves.move(ends, display(drawn), drawn)
    score = FlightScore(ends[0])
    score.move(ends[1], move)
    breaks, coef = score.spline()
    at = places(breaks, coef, np.linspace(0.0, move.duration, 300))
    return min(float(pdist(at[:, k] * STRETCH).min()) for k in range(300))


def formations(seed: int, count: int, roomy: float) -> tuple[Array, Array]:
    """Return two matched formations whose drones are at least so many separations apart."""
    rng = np.random.default_rng(seed)
    norms = rng.choice([1.0, 2.0, np.inf], 2)
    before, after = (lattice(count, rng.normal(scale=9.0, size=3), roomy, float(norm)) for norm in norms)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    after = ((after - after.mean(axis=0)) * STRETCH @ turn) / STRETCH + after.mean(axis=0)
    return before, after[matched(before * STRETCH, after * STRETCH)]


@pytest.mark.long
@settings(max_examples=examples(12, 300), deadline=None)
@given(
    seed=st.integers(0, 2**31),
    count=st.integers(3, 40),
    roomy=st.floats(1.45, 4.0),
    time=st.floats(0.2, 12.0),
    along=st.sampled_from(["right", "up", "out", "index"]),
    by=st.sampled_from(["goal", "start"]),
)
def test_what_is_planned_is_as_far_apart_as_it_has_to_be_and_what_is_refused_is_not(
    seed: int, count: int, roomy: float, time: float, along: Way, by: str
) -> None:
    ends = formations(seed, count, roomy)
    drawn = asked(wave=wave(time, along, by=by))
    mission = goals((fleet(count),), (display(drawn),), {"show": []}).keyframes.mission
    waves = Waves(
        mission, fleet(count), MoveSurroundings(room_of(mission, fleet(count)), Heights(-np.inf, np.inf))
    )
    least = least_sampled(ends, waves, drawn)
    assume([fault.code for fault in waves.faults] != ["D142"])  # three of a lattice may be alike
    if not waves.faults:
        assert least >= APART.across - 1e-6
        return
    (fault,) = waves.faults
    assert fault.code == "D141"
    attained = float(fault.message.split("come within ")[1].split(" m")[0])
    # What is told is the least there is, rounded up.
    assert attained < APART.across + 0.01
    assert least >= attained - 0.01
    if "write `time" in fault.help or "write `wave" in fault.help:
        longest = float(fault.help.split(": ")[1].split(" s")[0])
        assert 0.0 < longest < time
        again = drawn._replace(wave=wave(longest, along, by=by))
        waves.faults.clear()
        assert least_sampled(ends, waves, again) >= APART.across - 1e-6
        assert not waves.faults
    if " times that would be enough" in fault.notes[1]:
        factor = float(fault.notes[1].rsplit(" times that", 1)[0].rsplit(" ", 1)[1])
        middles = [0.5 * (at.min(axis=0) + at.max(axis=0)) for at in ends]
        before, after = (m + factor * (at - m) for m, at in zip(middles, ends, strict=True))
        waves.faults.clear()
        assert least_sampled((before, after), waves, drawn) >= APART.across - 1e-6
        assert not waves.faults


def flown(*pictures: Picture, count: int = 24, roomy: float = 2.6) -> ShowIR:
    """Return the flight of a display of two or three pictures, within its limits."""
    sets = [[lattice(count, [2.0 * k, 0, 40 + 3 * k], roomy, 2 + k)] for k in range(len(pictures))]
    level = goals((fleet(count),), (display(*pictures),), {"show": sets})
    done = AssignGoals().run(level, CONTEXT)
    assert done.value is not None, done.diagnostics
    bound = BoundSplines().run(done.value, CONTEXT).value
    assert bound is not None
    assert (bound.fleets[0].coef == done.value.fleets[0].coef).all()  # nothing had to be corrected
    return bound


def claim_of(ir: ShowIR, flight: FleetTrajectory, drawn: Picture) -> tuple[bool, float]:
    """Return whether the wave of the second picture holds, and what it misses, as verification has it."""
    proved = KeepApart().run(ir, CONTEXT).value
    assert proved is not None
    mission = ir.goals.keyframes.mission
    shown = mission.displays[0]
    mission = mission._replace(displays=(shown._replace(pictures=(shown.pictures[0], drawn)),))
    changed = replace(proved, keyframes=ir.goals.keyframes._replace(mission=mission), fleets=(flight,))
    found = [c for c in verdict_on(changed).certificate if c.constraint == "error of wave"]
    return all(c.holds for c in found), max(c.worst for c in found)


@pytest.mark.slow
def test_a_wave_is_flown_as_it_was_proved_and_nothing_bends_it() -> None:
    drawn = asked(wave=wave(3.0), transition=16.0, at=90.0)
    ir = flown(picture(path=("shots", 0, "frames", 0)), drawn)
    done = KeepApart().run(ir, CONTEXT)
    assert done.value is not None
    (flight,) = done.value.fleets
    assert (flight.coef == ir.fleets[0].coef).all()
    # The picture stands when the last one has arrived, at its time, and the way took what was asked.
    assert flight.shown[1].start == pytest.approx(90.0, abs=1e-6)
    assert flight.shown[1].start - flight.shown[0].end == pytest.approx(16.0, abs=1e-6)
    at = places(flight.breaks, flight.coef, np.array([89.9, 90.0, 92.0]))
    assert np.ptp(at, axis=1).max() < 1e-3
    # Lattices in one colour stand in the place of the pictures.
    assert {d.code for d in verdict_on(done.value).diagnostics} <= {"V064"}


@pytest.mark.slow
def test_a_plan_whose_drones_do_not_set_out_in_its_wave_is_refused() -> None:
    first = picture(path=("shots", 0, "frames", 0))
    drawn = asked(wave=wave(3.0), transition=16.0)
    ir = flown(first, drawn)
    holds, off = claim_of(ir, ir.fleets[0], drawn)
    assert holds
    assert off < 1.0
    holds, off = claim_of(ir, ir.fleets[0], drawn._replace(wave=wave(9.0)))
    assert not holds
    assert off == pytest.approx(6.0, abs=1.0)
    together = flown(first, drawn._replace(wave=None)).fleets[0]
    holds, off = claim_of(ir, together, drawn)
    assert not holds
    assert off == pytest.approx(3.0)


@pytest.mark.slow
def test_what_passes_too_near_in_a_wave_is_told_where_all_at_once_passes() -> None:
    sets = {"show": [[lattice(30, [0, 0, 40], 1.6, 2)], [lattice(30, [2, 0, 43], 1.6, np.inf)]]}
    first = picture(path=("shots", 0, "frames", 0))

    def codes(drawn: Picture) -> list[str]:
        level = goals((fleet(30),), (display(first, drawn),), sets)
        return [d.code for d in AssignGoals().run(level, CONTEXT).diagnostics]

    assert codes(asked()) == []
    assert codes(asked(wave=wave(6.0, "up"))) == ["D141"]
    assert codes(asked(wave=wave(6.0, "up"), transition=6.5)) == ["D080"]
    assert codes(asked(wave=wave(6.0, "up"), transition=6.5)._replace(easing="linear")) == ["D080"]


def test_a_first_picture_is_come_to_from_over_the_pads() -> None:
    drawn = picture(path=("shots", 0, "frames", 0), wave=wave(5.0, "east", by="start"))
    ir = flown(drawn)
    flight = ir.fleets[0]
    pads = grid(24)
    rise, stands = flight.phases[0].end, flight.shown[0].start
    middle = places(flight.breaks, flight.coef, np.array([rise, 0.5 * (rise + stands)]))
    gone = np.linalg.norm(middle[:, 1] - middle[:, 0], axis=1)
    assert gone[pads[:, 0] == pads[:, 0].min()].min() > gone[pads[:, 0] == pads[:, 0].max()].max()
