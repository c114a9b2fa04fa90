"""Pyro cues in a show file: one event for each product and drone, on a channel of its own."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from typing import Any

from shotc.ir.show import Display, Fleet, PyroCue
from shotc.show.emit.pyro_cues import carried


def programs_of(displays: Sequence[Display], fleet: Fleet) -> list[dict[str, Any] | None]:
    """Return the pyro programme of every drone of a fleet; None for a drone without products."""
    return [_program(cues) if cues else None for cues in carried(displays, fleet)]


def _program(cues: Sequence[PyroCue]) -> dict[str, Any]:
    """Return events [ignition in seconds, channel from 0, product] and the products, by channel from 1."""
    return {
        "version": 1,
        "events": [[round(cue.ignition, 3), k, str(k + 1)] for k, cue in enumerate(cues)],
        "payloads": {
            str(k + 1): {
                "name": cue.product,
                "duration": round(cue.duration, 3),
                "prefireTime": round(cue.prefire, 3),
                "yaw": round(degrees(cue.pan), 3),
                "pitch": round(degrees(cue.tilt), 3),
            }
            for k, cue in enumerate(cues)
        },
    }
