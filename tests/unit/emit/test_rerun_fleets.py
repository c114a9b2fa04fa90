"""Fleets in the recording: the logged tables."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

from shotc.emit.rerun_log import EMITTER
from shotc.emit.rerun_log.show import fleet_plots, nearest_pair, show_texts
from shotc.geom.fleet_spline import places
from shotc.ir.show import Apart
from tests.support import show_flights


@pytest.mark.slow
def test_a_fleet_is_one_cloud_over_time(tmp_path: Path) -> None:
    plan = show_flights.plan()
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
    assert {"/summary", "/plots/swarm/separation/nearest", "/plots/swarm/separation/limit"} <= entities
    flight = plan.trajectory.fleets[0]
    times = np.array(sorted(rows)) / 1e9
    assert len(times) == 351
    wanted = np.moveaxis(places(flight.breaks, flight.coef, times), 1, 0)
    assert np.abs(np.array([rows[k] for k in sorted(rows)]) - wanted).max() < 1e-4


@pytest.mark.parametrize("shape", ["ellipsoid", "cylinder"])
def test_the_nearest_pair_is_that_of_all_pairs(shape: str) -> None:
    apart = Apart(shape, 1.0, 2.0, 0.1)  # type: ignore[arg-type]
    for seed in range(20):
        points = np.random.default_rng(seed).uniform(0.0, 8.0, (40, 3))
        away = np.abs(points[:, None] - points[None])[np.triu_indices(40, 1)]
        flat, tall = np.hypot(away[:, 0], away[:, 1]), away[:, 2] * 1.1 / 2.1
        asked = np.hypot(flat, tall) if shape == "ellipsoid" else np.maximum(flat, tall)
        assert nearest_pair(points, apart) == pytest.approx(asked.min())


def test_plots_hold_the_extremes_of_all_drones_and_their_limits() -> None:
    plan = show_flights.plan()
    flight, fleet = plan.trajectory.fleets[0], plan.trajectory.keyframes.mission.fleets[0]
    t = np.array([0.0, 5.0, 20.0])
    plots = {plot.name: plot for plot in fleet_plots(fleet, flight, t)}
    assert plots["separation"].limits == (pytest.approx(1.15),)
    assert plots["separation"].lines[0].values[0] == pytest.approx(3.0), "the pads' spacing"
    rate = np.diff(places(flight.breaks, flight.coef, np.array([5.0, 5.0 + 1e-6])), axis=1)[:, 0] / 1e-6
    assert plots["climb"].lines[0].values[1] == pytest.approx(rate[:, 2].max(), abs=1e-4)
    assert plots["climb"].limits == (fleet.limits.climb, -fleet.limits.descent)


def test_words_tell_which_picture_stands() -> None:
    plan = show_flights.plan()
    flight = plan.trajectory.fleets[0]
    heads = {time: text.splitlines()[0] for time, text in show_texts(plan)}
    assert heads[0.0] == "## Taking off"
    assert heads[flight.shown[0].start] == "## Picture 1 of 2 of `shapes`"
    assert heads[flight.shown[0].end] == "## On the way to picture 2 of `shapes`"
    assert heads[flight.shown[1].start] == "## Picture 2 of 2 of `shapes`"


def test_words_tell_what_each_of_two_fleets_does() -> None:
    plan = show_flights.plan()
    first = plan.trajectory.fleets[0]
    late = tuple(replace(phase, start=phase.start + 1.0, end=phase.end + 1.0) for phase in first.phases[1:])
    second = replace(first, fleet="chorus", shown=(), phases=(first.phases[0], *late))
    both = replace(plan, trajectory=replace(plan.trajectory, fleets=(first, second)))
    texts = dict(show_texts(both))
    assert set(texts) == {time for time, _ in show_texts(plan)} | {phase.start for phase in second.phases}
    now = texts[second.phases[1].start]
    assert "## `chorus`: Flying to the next display" in now
    assert "## `swarm`: " in now
    assert "## `chorus`: Taking off" in texts[first.phases[1].start]
