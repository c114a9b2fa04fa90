"""One recording from beginning to end: the world, every flight, the words, the layout."""

from __future__ import annotations

from uuid import NAMESPACE_URL, uuid5

import numpy as np
import rerun as rr

from shotc.emit.rerun_log.layout import blueprint
from shotc.emit.rerun_log.motion import log_motion
from shotc.emit.rerun_log.text import phase_texts
from shotc.emit.rerun_log.world import log_world, scene_bounds
from shotc.ir.trajectory import VerifiedIR


def record(plan: VerifiedIR) -> bytes:
    """Return the recording of a plan, as a file with its footer.

    Bad data raises instead of being dropped (strict mode).
    """
    mission = plan.trajectory.keyframes.mission
    identity = uuid5(NAMESPACE_URL, f"shotc:{mission.name}:{mission.source_sha256}")
    strict = rr.strict_mode()
    rr.set_strict_mode(True)
    try:
        # The viewer keeps one layout for every application id, so each mission has its own.
        stream = rr.RecordingStream(f"shotc {mission.name}", recording_id=identity, send_properties=False)
        stream.set_log_time_enabled(False)
        stream.set_log_tick_enabled(False)
        memory = stream.memory_recording()
        _fill(stream, plan)
        return bytes(memory.drain_as_bytes())
    finally:
        rr.set_strict_mode(strict)


def _fill(stream: rr.RecordingStream, plan: VerifiedIR) -> None:
    mission = plan.trajectory.keyframes.mission
    bounds = scene_bounds(plan)
    log_world(stream, plan)
    frustum = float(np.clip(np.linalg.norm(bounds[1] - bounds[0]) / 14, 2.0, 40.0))
    flown = {
        flight.drone: (flight.curve.end, log_motion(stream, plan, flight, frustum))
        for flight in plan.trajectory.drones
    }
    for flight in plan.trajectory.drones[:1]:
        for start, text in phase_texts(plan, flight):
            stream.set_time("t", duration=start)
            stream.log("summary", rr.TextDocument(text, media_type="text/markdown"))
    stream.send_blueprint(blueprint(mission, flown, bounds), make_active=True, make_default=True)
