"""A show of three groups of one fleet: a ball, a ring under it all the time, fireworks that come and go."""

from __future__ import annotations

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory

TEXT = """\
shotc: 1
mission: three-groups
world: {origin: {lat: 53.5413, lon: 9.9841, alt: 6}}
fleets:
  swarm:
    count: 24
    layout: {grid: {spacing: 3, origin: [-6, 20, 0]}}
    separation: {horizontal: 1.5 m, vertical: 2 m}
    groups:
      fire: 1-4
      ring: [5-12, 24]
shots:
  - id: ball
    kind: display
    fleet: swarm
    viewpoint: [0, -110, 2]
    frames:
      - {sphere: {center: [0, 26, 45], radius: 6}, at: 35 s, hold: 20, color: orange}
      - {cube: {center: [0, 26, 45], size: 10}, at: 65 s, hold: 50, color: skyblue}
  - id: halo
    kind: display
    fleet: swarm
    group: ring
    frames: [{torus: {center: [0, 26, 25], radius: 7, tube: 1}, at: 35 s, hold: 85, color: gold}]
  - id: rain
    kind: display
    fleet: swarm
    group: fire
    timing: {start: 70 s}
    frames: [{torus: {center: [0, 26, 65], radius: 4, tube: 1}, hold: 6, color: white}]
    effects: [{fade: {to: black, time: 1 s}}]
    pyro: [{at: 71 s, drones: [1, 4], product: comet, duration: 2 s, clear: 4 m}]
"""
CROSSING = """\
shotc: 1
mission: two-groups
world:
  origin: {lat: 53.5413, lon: 9.9841, alt: 6}
fleets:
  swarm:
    count: 60
    layout: {grid: {spacing: 3, origin: [-12, -30, 0]}}
    separation: {horizontal: 1.5 m, vertical: 2 m}
    groups:
      fireworks: 1-8
      ring: [9-32, 60]
shots:
  - id: ball
    kind: display
    fleet: swarm
    viewpoint: [0, -110, 2]
    frames:
      - {sphere: {center: [0, 30, 45], radius: 9}, at: 35 s, hold: 20, color: orange}
      - {cube: {center: [0, 30, 45], size: 14}, at: 65 s, hold: 20, color: skyblue}
  - id: halo
    kind: display
    fleet: swarm
    group: ring
    viewpoint: [0, -110, 2]
    frames:
      - {torus: {center: [0, 30, 20], radius: 12, tube: 1}, at: 35 s, hold: 60, color: gold}
  - id: rain
    kind: display
    fleet: swarm
    group: fireworks
    viewpoint: [0, -110, 2]
    timing: {start: 50 s}
    frames:
      - {torus: {center: [0, 0, 30], radius: 10, tube: 1}, hold: 10, color: white}
    pyro:
      - {at: 52 s, drones: [1, 2, 8], product: fountain, duration: 4 s, clear: 4 m}
"""
"""Two of three groups fly home over each other's pads at about the same time."""

ACROSS, UPRIGHT = 1.5, 2.0


def least_between(one: FleetTrajectory, other: FleetTrajectory, times: Array) -> float:
    """Return how near any two come at any of the times, as the fleet's separation counts it, metres."""
    at = [places(flight.breaks, flight.coef, times) for flight in (one, other)]
    away = (at[0][:, None] - at[1][None]) * [1.0, 1.0, ACROSS / UPRIGHT]
    return float(np.linalg.norm(away, axis=3).min())
