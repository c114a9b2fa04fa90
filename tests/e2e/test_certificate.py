"""The certificate against the tables: samples come close to every proven worst value, and never beyond."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import Claim
from tests.e2e.conftest import Plan, Planned, each_mission
from tests.e2e.test_moving import from_its_place
from tests.support.csv_tables import TEXT, Table
from tests.support.solid_distances import apart, signed_distance
from tests.support.written_missions import KINDS

pytestmark = pytest.mark.parametrize("path", each_mission())

CLOSE = 1e-5
"""What nine digits of some hundred metres leave."""


def claims(planned: Planned, drone: str, shot: str | None = None) -> dict[str, Claim]:
    found = [c for c in planned.plan.certificate if (c.subject, c.shot) == (drone, shot)]
    assert len({claim.constraint for claim in found}) == len(found)
    return {claim.constraint: claim for claim in found}


def test_every_limit_is_written_with_a_certificate(plan: Plan, path: Path) -> None:
    planned = plan(path)
    assert all(claim.holds for claim in planned.plan.certificate if claim.hard)
    wanted = {"speed", "climb", "descent", "acceleration", "jerk", "ground clearance", "endurance"}
    wanted |= {"body yaw rate", "body yaw acceleration"}
    wanted |= {f"gimbal {axis} {what}" for axis in ("yaw", "pitch") for what in ("rate", "acceleration")}
    wanted |= {f"zone {zone.name}" for zone in planned.mission.zones}
    wanted |= {f"target {target.name}" for target in planned.mission.targets}
    for drone in planned.flights:
        assert wanted <= {name for name, claim in claims(planned, drone).items() if claim.hard}, drone
    spoken_of = {(claim.shot, claim.subject) for claim in planned.plan.certificate}
    assert {(shot.id, planned.filmed_by[shot.id]) for shot in planned.mission.shots} <= spoken_of


def test_worst_speeds_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for drone, motion in planned.flights.items():
        assert_worst_speeds(claims(planned, drone), motion, 1 / planned.mission.rate)


def assert_worst_speeds(found: dict[str, Claim], motion: Table, step: float) -> None:
    vx, vy, vz = motion.numbers("vx_m_s", "vy_m_s", "vz_m_s").T
    sampled = {
        "speed": np.hypot(vx, vy),
        "climb": vz,
        "descent": -vz,
        "acceleration": np.linalg.norm(motion.numbers("ax_m_s2", "ay_m_s2", "az_m_s2"), axis=1),
    }
    for name, values in sampled.items():
        claim = found[name]
        # Between two samples a value rises by no more than its rate allows.
        rise = found["jerk" if name == "acceleration" else "acceleration"].worst * step
        assert values.max() - CLOSE <= claim.worst <= values.max() + rise, name
        assert claim.time is not None
        assert np.interp(claim.time, motion["t_s"], values) >= claim.worst - rise, name


def test_least_distances_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for drone in planned.flights:
        assert_least_distances(planned, drone)


def assert_least_distances(planned: Planned, drone: str) -> None:
    found, motion = claims(planned, drone), planned.flights[drone]
    radius = planned.mission.drone(drone).radius
    motion = motion.rows(~np.isin(motion["phase"], ["takeoff", "land"]))
    free = motion.numbers("x_m", "y_m", "z_m")
    # Between two samples the body moves by no more than half a step at full speed.
    reach = fastest(found) / (2 * planned.mission.rate)
    assert_least(found["ground clearance"], free[:, 2] - radius, reach)
    for zone in planned.mission.zones:
        away = signed_distance(zone.solid, free)
        assert_least(found[f"zone {zone.name}"], (away if zone.keep == "out" else -away) - radius, reach)
    for target in planned.mission.targets:
        course = planned.courses[target.name]
        x, y, z = (free - course.at(motion["t_s"])).T
        sideways, upwards = np.hypot(x, y) - target.radius, np.abs(z) - target.height / 2
        away = np.hypot(np.maximum(sideways, 0), np.maximum(upwards, 0))
        legs = np.linalg.norm(np.diff(course.points, axis=0), axis=1) / np.diff(course.times)
        runs = legs.max(initial=0.0) / (2 * planned.mission.rate)
        assert_least(found[f"target {target.name}"], away - radius, reach + runs)


def fastest(found: dict[str, Claim]) -> float:
    return float(np.hypot(found["speed"].worst, max(found["climb"].worst, found["descent"].worst)))


def test_least_separations_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    told = {
        frozenset((c.subject, c.constraint.removeprefix("separation from "))): c
        for c in planned.plan.certificate
        if c.constraint.startswith("separation from ")
    }
    pairs = list(combinations(planned.flights, 2))
    assert set(told) == {frozenset(pair) for pair in pairs}
    for pair in pairs:
        claim = told[frozenset(pair)]
        assert claim.hard
        assert claim.limit == planned.mission.rules.separation
        reach = sum(fastest(claims(planned, drone)) for drone in pair) / (2 * planned.mission.rate)
        assert_least(claim, apart(planned.flights, *pair), reach)


def test_distances_from_a_place_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot in planned.written["shots"]:
        found = claims(planned, planned.filmed_by[shot["id"]], shot["id"])
        if shot["kind"] not in KINDS:
            assert "distance from its place" not in found
            continue
        _, away = from_its_place(planned, shot)
        # The end of a shot is judged as well, and is no tick of its rows.
        assert away.max() - CLOSE <= found["distance from its place"].worst <= away.max() + 0.05


def assert_least(claim: Claim, sampled: Array, reach: float) -> None:
    slack = 1e-3 + 2e-4 * abs(sampled.min())  # a bound far from its limit is closed to a ten-thousandth
    assert sampled.min() - reach - slack <= claim.worst <= sampled.min() + CLOSE, claim.constraint


def test_framing_claims_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot in planned.mission.shots:
        found = claims(planned, planned.filmed_by[shot.id], shot.id)
        for name in set(planned.framing["target"][planned.framing["shot"] == shot.id]):
            rows = planned.framing.where(shot=shot.id, target=name)
            error = np.hypot(rows["u"] - rows["u_ref"], rows["v"] - rows["v_ref"])
            if f"{name} screen error" in found:
                assert 0 <= found[f"{name} screen error"].worst - np.nanmax(error) + 1e-8 < 1e-3
            # The ends of a shot are judged as well, and are no ticks of the table.
            few = 2 / len(rows)
            assert found[f"{name} in frame"].worst == pytest.approx(rows["in_frame"].mean(), abs=few)
            shown = (rows["covered"] <= 0.5).mean()
            assert found[f"{name} in sight"].worst == pytest.approx(shown, abs=few)
            assert found[f"{name} visible"].worst <= 1 - rows["covered"].max() + 1e-8
            assert 0 <= found[f"{name} size largest"].worst - np.nanmax(rows["size"]) + 1e-8 < 1e-2
            assert 0 <= np.nanmin(rows["size"]) - found[f"{name} size smallest"].worst + 1e-8 < 1e-2


def test_endurance_is_the_whole_flight_from_the_pad_on(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for drone, motion in planned.flights.items():
        claim, t = claims(planned, drone)["endurance"], motion["t_s"]
        earliest, latest = lift_off(motion)
        assert t[-2] - latest < claim.worst <= t[-1] - earliest + 1e-9
        assert claim.limit == planned.mission.drone(drone).endurance


def lift_off(motion: Table) -> tuple[float, float]:
    """Between which times a drone leaves its pad; one that moves at the first step leaves it at once."""
    names = [name for name in motion.header if name not in ("t_s", *TEXT)]
    rows = motion.numbers(*names)
    still = ((rows == rows[0]) | np.isnan(rows[0])).all(axis=1)  # what is not known is empty
    first = int(np.argmin(still))
    t = motion["t_s"]
    return (0.0, 0.0) if first == 1 else (float(t[first - 1]), float(t[first]))
