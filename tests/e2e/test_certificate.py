"""The certificate against the tables: samples come close to every proven worst value, and never beyond."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.trajectory import Claim
from tests.e2e.conftest import Plan, Planned, each_mission
from tests.e2e.space import signed_distance

pytestmark = pytest.mark.parametrize("path", each_mission())

CLOSE = 1e-5
"""What nine digits of some hundred metres leave."""


def claims(planned: Planned, shot: str | None = None) -> dict[str, Claim]:
    return {claim.constraint: claim for claim in planned.plan.certificate if claim.shot == shot}


def test_every_limit_is_written_with_a_certificate(plan: Plan, path: Path) -> None:
    planned = plan(path)
    assert all(claim.holds for claim in planned.plan.certificate if claim.hard)
    spoken = {claim.constraint for claim in planned.plan.certificate if claim.hard}
    wanted = {"speed", "climb", "descent", "acceleration", "jerk", "ground clearance", "endurance"}
    wanted |= {"body yaw rate", "body yaw acceleration"}
    wanted |= {f"gimbal {axis} {what}" for axis in ("yaw", "pitch") for what in ("rate", "acceleration")}
    wanted |= {f"zone {zone.name}" for zone in planned.mission.zones}
    wanted |= {f"target {target.name}" for target in planned.mission.targets}
    assert wanted <= spoken
    assert {shot.id for shot in planned.mission.shots} <= {claim.shot for claim in planned.plan.certificate}


def test_worst_speeds_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    found = claims(planned)
    vx, vy, vz = planned.motion.numbers("vx_m_s", "vy_m_s", "vz_m_s").T
    sampled = {
        "speed": np.hypot(vx, vy),
        "climb": vz,
        "descent": -vz,
        "acceleration": np.linalg.norm(planned.motion.numbers("ax_m_s2", "ay_m_s2", "az_m_s2"), axis=1),
    }
    step = 1 / planned.mission.rate
    for name, values in sampled.items():
        claim = found[name]
        # Between two samples a value rises by no more than its rate allows.
        rise = found["jerk" if name == "acceleration" else "acceleration"].worst * step
        assert values.max() - CLOSE <= claim.worst <= values.max() + rise, name
        assert claim.time is not None
        assert np.interp(claim.time, planned.motion["t_s"], values) >= claim.worst - rise, name


def test_least_distances_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    found = claims(planned)
    radius = planned.mission.drones[0].radius
    free = planned.motion.numbers("x_m", "y_m", "z_m")[~np.isin(planned.motion["phase"], ["takeoff", "land"])]
    # Between two samples the body moves by no more than half a step at full speed.
    reach = np.hypot(found["speed"].worst, max(found["climb"].worst, found["descent"].worst))
    reach /= 2 * planned.mission.rate
    assert_least(found["ground clearance"], free[:, 2] - radius, reach)
    for zone in planned.mission.zones:
        away = signed_distance(zone.solid, free)
        assert_least(found[f"zone {zone.name}"], (away if zone.keep == "out" else -away) - radius, reach)


def assert_least(claim: Claim, sampled: Array, reach: float) -> None:
    slack = 1e-3 + 2e-4 * abs(sampled.min())  # a bound far from its limit is closed to a ten-thousandth
    assert sampled.min() - reach - slack <= claim.worst <= sampled.min() + CLOSE, claim.constraint


def test_framing_claims_are_those_of_the_table(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot in planned.mission.shots:
        found = claims(planned, shot.id)
        for name in set(planned.framing["target"][planned.framing["shot"] == shot.id]):
            rows = planned.framing.where(shot=shot.id, target=name)
            error = np.hypot(rows["u"] - rows["u_ref"], rows["v"] - rows["v_ref"])
            if f"{name} screen error" in found:
                assert 0 <= found[f"{name} screen error"].worst - np.nanmax(error) + 1e-8 < 1e-3
            # The ends of a shot are judged as well, and are no ticks of the table.
            few = 2 / len(rows)
            assert found[f"{name} in frame"].worst == pytest.approx(rows["in_frame"].mean(), abs=few)
            assert found[f"{name} visible"].worst == pytest.approx(1 - rows["occluded"].mean(), abs=few)
            assert 0 <= found[f"{name} size largest"].worst - np.nanmax(rows["size"]) + 1e-8 < 1e-2
            assert 0 <= np.nanmin(rows["size"]) - found[f"{name} size smallest"].worst + 1e-8 < 1e-2


def test_endurance_is_the_whole_flight(plan: Plan, path: Path) -> None:
    planned = plan(path)
    claim = claims(planned)["endurance"]
    assert planned.motion["t_s"][-2] < claim.worst <= planned.motion["t_s"][-1] + 1e-9
    assert claim.limit == planned.mission.drones[0].endurance
