"""A whole recording: world, flights, texts and layout."""

from __future__ import annotations

from collections.abc import Callable
from re import sub
from typing import Any
from unicodedata import normalize
from uuid import NAMESPACE_URL, uuid5

import numpy as np
import rerun as rr

from shotc.emit.rerun_log.clock import Clocked
from shotc.emit.rerun_log.fleets import log_fleets, log_words, show_blueprint, shown_span
from shotc.emit.rerun_log.layout import blueprint
from shotc.emit.rerun_log.motion import log_motion
from shotc.emit.rerun_log.opening import filmed_span
from shotc.emit.rerun_log.text import phase_texts
from shotc.emit.rerun_log.world import log_world
from shotc.emit.scene_extent import scene_bounds
from shotc.geom.bernstein import Array
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import VerifiedIR

NOT_ALLOWED = r"[^A-Za-z0-9 _-]"
"""What an application id may not hold: the viewer replaces it, with a warning on the terminal."""

NUMBER_DIGITS = 6


def record(plan: VerifiedIR) -> bytes:
    """Return the recording of a plan, as a file with its footer.

    Invalid data raises an error instead of being dropped (strict mode of rerun).
    """
    return recorded(plan.trajectory.keyframes.mission, "", lambda stream: _fill(stream, plan))


def _plain(name: str) -> str:
    """Return a name in the characters that the viewer allows in an application id.

    A name that loses some gets a number, so that two names stay different.
    """
    plain = sub(NOT_ALLOWED, "-", normalize("NFKD", name).encode("ascii", "ignore").decode())
    return plain if plain == name else f"{plain} {uuid5(NAMESPACE_URL, name).hex[:NUMBER_DIGITS]}"


def recorded(mission: MissionIR, what: str, fill: Callable[[Any], None]) -> bytes:
    """Return a recording of a mission.

    what : the part of the mission that it shows; "" for all of it
    fill : logs the content into a stream
    """
    identity = uuid5(NAMESPACE_URL, f"shotc:{what}{mission.name}:{mission.source_sha256}")
    strict = rr.strict_mode()
    rr.set_strict_mode(True)
    try:
        # The viewer keeps one layout for each application id, so each mission has its own.
        stream = rr.RecordingStream(
            f"shotc {what}{_plain(mission.name)}", recording_id=identity, send_properties=False
        )
        stream.set_log_time_enabled(False)
        stream.set_log_tick_enabled(False)
        memory = stream.memory_recording()
        fill(stream)
        return bytes(memory.drain_as_bytes())
    finally:
        rr.set_strict_mode(strict)


def _fill(recording: rr.RecordingStream, plan: VerifiedIR) -> None:
    first = filmed_span(plan) or shown_span(plan)
    stream = recording if first is None else Clocked(recording, first[0])
    bounds = scene_bounds(plan)
    log_world(stream, plan)
    frustum = frustum_length(bounds)
    flown = {
        flight.drone: (flight.curve.end, log_motion(stream, plan, flight, frustum))
        for flight in plan.trajectory.drones
    }
    for flight in plan.trajectory.drones[:1]:
        for start, text in phase_texts(plan, flight):
            stream.set_time("t", duration=start)
            stream.log("summary", rr.TextDocument(text, media_type="text/markdown"))
    plots = log_fleets(stream, plan)
    alone = plan.trajectory.fleets and not flown
    if alone:
        log_words(stream, plan)
    layout = show_blueprint(plan, bounds, plots) if alone else blueprint(plan, flown, bounds)
    recording.send_blueprint(layout, make_active=True, make_default=True)


def frustum_length(bounds: tuple[Array, Array]) -> float:
    """Return the distance of the drawn image plane from its camera, metres, for a scene with
    these opposite corners, (3,) each, metres.
    """
    return float(np.clip(np.linalg.norm(bounds[1] - bounds[0]) / 14, 2.0, 40.0))
