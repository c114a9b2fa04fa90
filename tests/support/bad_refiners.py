"""A mission of two shots, refiners that do what they are told, and ways to spoil a path."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import MovingLeg, PathIR
from shotc.passes.refine_path import RefinePath, Seat

MISSION = """\
shotc: 1
mission: yard
world:
  zones:
    tree: {keep: out, cylinder: {center: [-20, -38], radius: 3, height: [0, 30]}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -60, 0], gimbal: {pitch: [-60 deg, 20 deg]}}}
shots:
  - id: pass
    kind: keyframes
    drone: cam
    target: mast
    composition: center
    keyframes:
      - {at: [-40, -30, 10], look_at: mast}
      - {at: [0, -30, 12], look_at: mast}
      - {at: [30, -25, 14], look_at: mast}
  - id: round
    kind: orbit
    drone: cam
    target: mast
    composition: center
    radius: 25
    altitude: 12
    start_azimuth: 120 deg
    sweep: -90 deg
"""
PASS, ROUND = "pass", "round"


def accepting(mission: str, *optional: str) -> str:
    """Return a mission in which some shots accept their convex paths."""
    for shot in optional:
        mission = mission.replace(f"id: {shot}\n", f"id: {shot}\n    refine: {{optional: true}}\n")
    return mission


@cache
def convex_path(mission: str) -> PathIR:
    """Return the convex path of a mission."""
    options = PlanOptions(refiner="none", stop_after="solve-path-qp")
    done = compile_source(mission.encode(), "yard.yaml", None, options)
    assert done.reports[-1].output is not None, done.diagnostics
    return done.reports[-1].output


def text(*optional: str) -> str:
    """Return the mission in which some shots accept their convex paths."""
    return accepting(MISSION, *optional)


def path(*optional: str) -> PathIR:
    """Return the convex path of the mission."""
    return convex_path(text(*optional))


class Odd:
    """A refiner that does what it is told."""

    name, summary, api = "odd", "odd", 1

    def __init__(self, act):
        self.refine = lambda path, ctx: act(path)


def refine(act, *optional: str, path_of=path):
    """Refine the mission's path by ``act``."""
    return RefinePath(Seat(Odd(act), "odd-maker")).run(path_of(*optional), PassContext())


def leg(ir: PathIR, shot: str) -> MovingLeg:
    return next(leg for leg in ir.drones[0].legs if leg.shot == shot)


def with_leg(ir: PathIR, which: str | int, **changes) -> PathIR:
    """Return the path with one leg changed: that of a shot, or by its number."""
    legs = list(ir.drones[0].legs)
    k = which if isinstance(which, int) else legs.index(leg(ir, which))
    legs[k] = replace(legs[k], **changes)
    return replace(ir, drones=(replace(ir.drones[0], legs=tuple(legs)),))


def bumped(ir: PathIR, shot: str, by, between=(0.0, 1.0)) -> PathIR:
    """Bend a shot's curve by a smooth bump, as large as ``by``, shape (7,), between two shares of it."""
    curve = leg(ir, shot).curve
    low, high = (curve.start + share * (curve.end - curve.start) for share in between)
    x = np.clip((curve.breaks - low) / (high - low), 0.0, 1.0)
    polynomial = np.polynomial.Polynomial([0, 1, -1]) ** 3 * 64
    bump = [polynomial.deriv(k)(x)[:, None] * np.array(by) / (high - low) ** k for k in (1, 2)]
    value = polynomial(x)[:, None] * np.array(by)
    ctrl = curve.ctrl + quintic_hermite(curve.breaks, value, *bump).ctrl
    return with_leg(ir, shot, curve=Piecewise(curve.breaks, ctrl))


def along(channel: int, by: float):
    return [by if k == channel else 0.0 for k in range(7)]


def nan(ir: PathIR, shot: str = PASS) -> PathIR:
    """Return a path with a number that is none, past the checks of a curve's own."""
    curve = leg(ir, shot).curve
    made = Piecewise(curve.breaks, curve.ctrl)
    ctrl = curve.ctrl.copy()
    ctrl[1, 2, 0] = np.nan
    object.__setattr__(made, "ctrl", ctrl)
    return with_leg(ir, shot, curve=made)


def jolted(ir: PathIR, shot: str, order: int) -> PathIR:
    """Return a path in which a derivative of a shot's curve jumps at a break."""
    curve = leg(ir, shot).curve
    ctrl = curve.ctrl.copy()
    ctrl[len(ctrl) // 2, order, 0] += 1e-2
    return with_leg(ir, shot, curve=Piecewise(curve.breaks, ctrl))


def returns(make):
    """Return an act that answers with a changed path."""
    return lambda ir: Outcome(make(ir))
