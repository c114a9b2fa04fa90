"""Missions with one framing of what moves or stands, their plans and claims."""

from __future__ import annotations

from shotc.ir.trajectory import VerifiedIR
from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: faces
{world}targets:
  runner:
    {{track: {{points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: 3 m/s}}, radius: 0.4, height: 1.8}}
  rider:
    {{track: {{points: [[0, 3, 1], [60, 3, 1], [90, 33, 1]], speed: 3 m/s}}, radius: 0.6, height: 2}}
  tower: {{at: [30, 60, 12], radius: 4, height: 24}}
drones:
  cam1: {{model: x500, home: [45, -20, 0]}}
shots:
  - {{id: s, kind: framing, drone: cam1, timing: {{start: 15, duration: 8}}, {require}subjects: [{subjects}]}}
"""


def text(*subjects: str, world: str = "", require: str = "") -> str:
    """Return the mission of one framing, of these subjects."""
    return MISSION.format(subjects=", ".join(f"{{{s}}}" for s in subjects), world=world, require=require)


def planned(mission: str) -> VerifiedIR:
    """Return the plan of a mission under the convex path."""
    done = compiled_text(mission, "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return done.plan


def claim(plan: VerifiedIR, name: str) -> float:
    """Return the worst value of the first claim of this name."""
    return next(c.worst for c in plan.certificate if c.constraint == name)
