"""The files of a rehearsal."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

from shotc import plugins
from shotc.emit.base import Artifact, Emission
from shotc.emit.report import report
from shotc.emit.report.page import Simulated
from shotc.ir.trajectory import VerifiedIR
from shotc.simulation.document import flight_table, json_text
from shotc.simulation.plots import draw
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.runs import flown
from shotc.simulation.summary import summary


def artifacts(rehearsed: Rehearsed, plan: VerifiedIR, progress: Callable[[str], None]) -> Emission:
    """Return the report, simulate.json and simulate.png; for missions with cameras also flight.csv and
    simulate.rrd.

    All but the recording are reproducible. The recording is left out with a warning if rerun is not
    installed.

    plan : the simulated plan
    """
    described = summary(rehearsed)
    files = [
        Artifact("simulate.json", json_text(rehearsed).encode("ascii")),
        report(
            plan, Simulated(described.flown, described.tables, (*described.requirements, *described.notes))
        ),
    ]
    if not rehearsed.ir.drones:
        return Emission((*files, Artifact("simulate.png", draw(rehearsed))))
    progress("flying the worst run again")
    world, worst = flown(rehearsed.ir, rehearsed.conditions, [rehearsed.worst.number])
    files.append(Artifact("flight.csv", flight_table(rehearsed, world, worst).encode()))
    progress("drawing simulate.png")
    files.append(Artifact("simulate.png", draw(rehearsed)))
    if find_spec("rerun") is None:
        missing = plugins.not_installed("P005", "output `simulate.rrd`", ["rerun"])
        return Emission(tuple(files), (missing,))
    from shotc.simulation.recording import recording

    progress("recording simulate.rrd")
    files.append(Artifact("simulate.rrd", recording(rehearsed, world, worst)))
    return Emission(tuple(files))
