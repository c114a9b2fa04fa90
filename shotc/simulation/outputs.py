"""The files of a rehearsal."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

import numpy as np

from shotc import plugins
from shotc.emit.base import Artifact, Emission
from shotc.geom.bernstein import Array
from shotc.simulation.document import flight_table, json_text
from shotc.simulation.flight import Flown
from shotc.simulation.plots import Strays, draw
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.runs import BLOCK, flown
from shotc.simulation.world import at_times


def artifacts(done: Rehearsed, progress: Callable[[str], None]) -> Emission:
    """Return simulate.json and simulate.png, and of plans with cameras flight.csv and simulate.rrd, too.

    All but the recording are the same every time. Where rerun is not installed it is left out with a warning.
    """
    made = [Artifact("simulate.json", json_text(done).encode("ascii"))]
    if not done.ir.drones:
        return Emission((*made, Artifact("simulate.png", draw(done, None))))
    progress("flying the worst run again")
    world, worst = flown(done.ir, done.conditions, [done.worst.number])
    made.append(Artifact("flight.csv", flight_table(done, world, worst).encode()))
    progress("drawing simulate.png")
    made.append(Artifact("simulate.png", draw(done, _strays(done))))
    if find_spec("rerun") is None:
        missing = plugins.not_installed("P005", "output `simulate.rrd`", ["rerun"])
        return Emission(tuple(made), (missing,))
    from shotc.simulation.recording import recording

    progress("recording simulate.rrd")
    made.append(Artifact("simulate.rrd", recording(done, world, worst)))
    return Emission(tuple(made))


def _strays(done: Rehearsed) -> Strays:
    """Return how far drones stray over time; the first block of runs stands for all of them."""
    _, tracks = flown(done.ir, done.conditions, [run.number for run in done.runs[:BLOCK]])
    times = max((each.times for each in tracks), key=len)
    off = np.max([_off(done, each, times) for each in tracks], axis=0)
    return Strays(times, np.asarray(np.median(off, axis=1)), off.max(axis=1))


def _off(done: Rehearsed, each: Flown, times: Array) -> Array:
    track = next(t for t in done.ir.drones if t.drone == each.drone)
    planned = track.curve(times)[:, None, :3]
    return np.asarray(np.linalg.norm(at_times(each.position, each.times, times) - planned, axis=2))
