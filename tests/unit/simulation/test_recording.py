"""simulate.rrd of a replanned flight, read back: it shows what was planned, flown and estimated."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

from shotc.geom.track import Track
from shotc.simulation.conditions import Conditions
from shotc.simulation.recording import recording
from shotc.simulation.rehearsal import rehearse
from shotc.simulation.runs import flown as flights_of
from shotc.simulation.runs import simulated
from shotc.simulation.truth import Truth
from shotc.simulation.wind import WindField
from shotc.simulation.world import at_times
from tests.support.compiled import compiled_text
from tests.unit.simulation.test_deviations import BIKE

pytestmark = [pytest.mark.slow, pytest.mark.long]

VEERS = Truth(tracks=(("rider", Track((0.0, 90.0), ((0.0, 0.0, 0.9), (270.0, 45.0, 0.9)))),))


def columns(path: Path) -> dict[tuple[str, str], tuple[np.ndarray, list]]:
    """The times in seconds and the rows of each column that changes over time, by entity and component."""
    rows = defaultdict(list)
    for chunk in RrdReader(path).stream().to_chunks():
        batch = chunk.to_record_batch()
        if "t" not in batch.schema.names:
            continue
        times = [t / 1e9 for t in batch.column("t").cast("int64").to_pylist()]
        for name in (name for name in batch.schema.names if ":" in name):
            values = zip(times, batch.column(name).to_pylist(), strict=True)
            rows[chunk.entity_path, name] += [(t, row[0]) for t, row in values if row]
    return {key: (np.array([t for t, _ in each]), [row for _, row in each]) for key, each in rows.items()}


def test_the_recording_shows_the_plan_the_flight_and_the_estimates(tmp_path: Path) -> None:
    plan = compiled_text(BIKE, "none").plan
    assert plan is not None
    ir, conditions = (
        plan.trajectory,
        Conditions(loop="replan", truth=VEERS, wind=WindField(2.0, None, 0.5)),
    )
    done = rehearse(ir, conditions, simulated(ir, conditions, 1, 1), lambda _: None)
    world, (cam,) = flights_of(ir, conditions, [0])
    path = tmp_path / "simulate.rrd"
    path.write_bytes(recording(done, world, (cam,)))
    read = columns(path)
    when = np.arange(14.0, 19.0, 0.25)

    def shown(entity: str, component: str = "Transform3D:translation") -> np.ndarray:
        return at_rows(*read[entity, component], when)

    def really(rows: np.ndarray) -> np.ndarray:
        return at_times(rows, cam.times, when)

    ghost, drone = shown("/world/plan/cam/at"), shown("/world/drones/cam")
    assert ghost == pytest.approx(ir.drones[0].curve(when)[:, :3], abs=0.02)
    assert drone == pytest.approx(really(cam.position[:, 0]), abs=0.01)
    assert np.linalg.norm(drone - ghost, axis=1).max() > 1.0  # it follows the rider off his track
    assert shown("/world/cameras/cam") == pytest.approx(drone, abs=1e-6)

    rider = at_times(world.places["rider"][:, 0], world.times, when)
    assert shown("/world/targets/rider") - rider == pytest.approx(
        np.tile([0.0, 0.0, -0.9], (20, 1)), abs=0.01
    )
    (known,) = cam.estimated
    assert shown("/world/estimates/cam/rider") == pytest.approx(really(known.place[:, 0]), abs=1e-3)
    half = shown("/world/estimates/cam/rider", "Ellipsoids3D:half_sizes")
    spread = np.trace(really(known.covariance[:, 0]), axis1=1, axis2=2)
    assert (half**2).sum(axis=1) / 4 == pytest.approx(spread, rel=1e-2)

    x, y, z, w = shown("/world/cameras/cam", "Transform3D:quaternion").T
    ahead = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    to = rider - drone
    off = np.arccos((ahead * to).sum(axis=1) / np.linalg.norm(to, axis=1))
    middle = shown("/world/cameras/cam/screen/rider/centre", "Points3D:positions")
    assert np.degrees(off).max() < 1.5  # the camera looks at the rider, who is in the middle of its screen
    assert np.abs(middle[:, :2]).max() < 0.1


def at_rows(times: np.ndarray, rows: list, when: np.ndarray) -> np.ndarray:
    return np.column_stack([np.interp(when, times, column) for column in np.array(rows).T])
