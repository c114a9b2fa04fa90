"""simulate.json: the results of every run, for programs; and flight.csv: the worst run over time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from math import isfinite
from typing import Any

import numpy as np

from shotc import __version__
from shotc.emit.table_numbers import NUMBER
from shotc.ir.sampling import clock
from shotc.simulation.flight import DroneRuns, Estimated
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.world import World, at_times

FLIGHT = (
    "t_s,run,drone,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,cam_yaw_rad,cam_pitch_rad,cam_roll_rad,"
    "plan_x_m,plan_y_m,plan_z_m,target,target_x_m,target_y_m,target_z_m,"
    "estimate_x_m,estimate_y_m,estimate_z_m,estimate_sd_m"
)


def json_text(rehearsed: Rehearsed) -> str:
    """Return the document; the same rehearsal gives the same text on any number of processes."""
    mission = rehearsed.mission
    document = {
        "tool": {"name": "shotc", "version": __version__},
        "mission": mission.name,
        "mission_sha256": mission.source_sha256,
        "conditions": asdict(rehearsed.conditions),
        "asked": rehearsed.promise._asdict(),
        "runs_that_hold": rehearsed.held,
        "runs_needed": rehearsed.needed,
        "kept": rehearsed.kept,
        "verdicts": [asdict(each) for each in rehearsed.verdicts],
        "worst_run": rehearsed.worst.number,
        "runs": [asdict(run) for run in rehearsed.runs],
    }
    return json.dumps(_finite(document), indent=2) + "\n"


def _finite(value: Any) -> Any:
    """Return a document in which infinite and undefined numbers are words, as in plan.json."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return _finite(value._asdict())
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return str(value) if isinstance(value, float) and not isfinite(value) else value


def flight_table(rehearsed: Rehearsed, world: World, flown: Sequence[DroneRuns]) -> str:
    """Return flight.csv of the first run of a world at the ticks of the output clock, by drone, then by time.

    A drone that follows several targets has a row for each; a drone that follows none has one row.
    """
    rows = [
        row
        for track, each in sorted(
            zip(rehearsed.ir.drones, flown, strict=True), key=lambda pair: pair[0].drone
        )
        for row in _rows(rehearsed, world, each, clock(rehearsed.mission.rate, track.curve.end))
    ]
    return "\n".join([FLIGHT, *rows, ""])


def _rows(rehearsed: Rehearsed, world: World, flown: DroneRuns, times: Any) -> Iterator[str]:
    track = next(t for t in rehearsed.ir.drones if t.drone == flown.drone)
    angles = np.stack([np.unwrap(flown.yaw[:, 0]), flown.pitch[:, 0], flown.roll[:, 0]], axis=1)
    own = np.concatenate(
        [at_times(rows, flown.times, times) for rows in (flown.position[:, 0], flown.velocity[:, 0], angles)]
        + [track.curve(times)[:, :3]],
        axis=1,
    )
    of_targets = [(e.target, _known(world, flown, e, times)) for e in flown.estimated]
    head = f"{NUMBER},{world.runs[0]},{flown.drone}"
    for k, time in enumerate(times.tolist()):
        numbers = ",".join(NUMBER % (value + 0.0) for value in own[k].tolist())
        for name, known in of_targets or [("", None)]:
            cells = (
                ",,,,,," if known is None else ",".join(NUMBER % (value + 0.0) for value in known[k].tolist())
            )
            yield f"{head % time},{numbers},{name},{cells}"


def _known(world: World, flown: DroneRuns, of: Estimated, times: Any) -> Any:
    """Return the true position of a target, its estimate, and the estimate's standard deviation, (M, 7)."""
    spread = np.sqrt(np.trace(of.covariance[:, 0], axis1=1, axis2=2) / 3.0)
    return np.column_stack(
        [
            at_times(world.places[of.target][:, 0], world.times, times),
            at_times(of.place[:, 0], flown.times, times),
            at_times(spread, flown.times, times),
        ]
    )
