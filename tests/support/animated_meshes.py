"""A mission whose fleet shows a ball that turns and stretches, a mesh a frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tests.support.meshes import ply, sphere_mesh


def animated(folder: Path, drones: int, frames: int, period: float) -> bytes:
    """Return the mission, as dense at any size, and write its meshes to a folder."""
    radius, side = 0.9 * drones ** (1 / 3), int(np.ceil(drones**0.5))
    ball, corner = sphere_mesh(radius, 12), -0.75 * side
    for k in range(frames):
        c, s, tall = np.cos(0.04 * k), np.sin(0.04 * k), 1.0 + 0.35 * np.sin(np.pi * k / 10)
        turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        (folder / f"{k:03d}.ply").write_bytes(ply(ball * [tall**-0.5, tall**-0.5, tall] @ turn.T))
    at = f"center: [0, 0, {30 + 2 * radius:.1f}], height: {2 * radius:.2f}"
    return f"""\
shotc: 1
mission: animated
fleets:
  swarm:
    count: {drones}
    layout: {{grid: {{spacing: 1.5, origin: [{corner}, {corner}, 0]}}}}
    separation: {{horizontal: 0.7 m, vertical: 0.8 m}}
    rise: 5 m
shots:
  - id: body
    kind: display
    fleet: swarm
    frames:
      - model: {{files: "*.ply", period: {period}, units: m, {at}}}
        hold: 2
""".encode()
