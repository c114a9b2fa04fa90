"""One planned mission of several kinds, standing and moving, for tests that edit its plan."""

from functools import cache

from shotc import api

MISSION = """\
shotc: 1
mission: kinds
targets:
  tower: {at: [0, 0, 10], radius: 3, height: 20}
  runner: {track: {start: [80, 0, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
  cam2: {model: x500, home: [70, -20, 0], priority: 2}
rules: {mutual_visibility: {strength: off}, transit_clearance: {filmed: 0, other: 0}}
shots:
  - {id: round, kind: orbit, drone: cam1, target: tower, radius: 30, altitude: 15, sweep: -180 deg,
     start_azimuth: 180 deg}
  - {id: rise, kind: elevator, drone: cam1, target: tower, azimuth: 0 deg, distance: 35, altitude: [8, 24]}
  - id: look
    kind: keyframes
    drone: cam1
    require: {in_frame: 30 %}
    allow: [fast-pan]
    keyframes:
      - {at: [-40, 10, 12], heading: 200 deg, pitch: -5 deg}
      - {at: [-40, -10, 12], heading: 240 deg, pitch: -5 deg, hold: 2}
      - {at: [-30, -30, 14], look_at: tower}
      - {at: [-20, -35, 14], look_at: tower, hfov: 60 deg}
  - {id: side, kind: lateral, drone: cam2, target: runner, side: left, distance: 8, altitude: 3,
     timing: {duration: 8}, require: {screen_error: 0.5}}
"""


@cache
def kinds_plan(edits: tuple[tuple[str, str], ...] = ()) -> bytes:
    """Return the plan.json of the mission, on its convex path; edits : (old, new) in its text."""
    text = MISSION
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    done = api.compile_source(text.encode(), "kinds.yaml", None, api.PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    return api.emit_plan(done.plan, []).artifacts[0].data
