"""Fleets in the recording: the logged tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from rerun.chunk import RrdReader

from shotc.emit.rerun_log import EMITTER
from shotc.geom.fleet_spline import places
from tests import sky


def test_a_fleet_is_one_cloud_over_time(tmp_path: Path) -> None:
    plan = sky.plan()
    path = tmp_path / "mission.rrd"
    path.write_bytes(EMITTER.emit(plan).artifacts[0].data)
    rows: dict[int, list[list[float]]] = {}
    entities = set()
    for chunk in RrdReader(path).stream().to_chunks():
        entities.add(str(chunk.entity_path))
        batch = chunk.to_record_batch()
        if str(chunk.entity_path) == "/world/fleets/swarm" and "Points3D:positions" in batch.schema.names:
            times = batch.column("t").cast("int64").to_pylist()
            rows |= dict(zip(times, batch.column("Points3D:positions").to_pylist(), strict=True))
    assert {"/world/pads/swarm", "/world/audience/shapes", "/world/zones/field/edges"} <= entities
    flight = plan.trajectory.fleets[0]
    times = np.array(sorted(rows)) / 1e9
    assert len(times) == 351
    wanted = np.moveaxis(places(flight.breaks, flight.coef, times), 1, 0)
    assert np.abs(np.array([rows[k] for k in sorted(rows)]) - wanted).max() < 1e-4
