"""A straight shot of forty metres, timed by the pass, and what can be read off the result."""

from __future__ import annotations

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.ir.path import MovingLeg, PathIR, PathLeg
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.parameterize_time import ParameterizeTime
from tests.support.timing_paths import (
    HFOV,
    flight,
    line,
    mission,
    s_curve_time,
    shot_leg,
    shot_phase,
)

FROM = (0.0, 0.0, 10.0, 0.0, 0.0, 0.0, HFOV)
TO = (40.0, 0.0, 10.0, 0.0, 0.0, 0.0, HFOV)
FORTY = s_curve_time(40.0, 8.0, 3.0, 8.0)


def straight(**changes: object) -> MovingLeg:
    return shot_leg(line(FROM, TO), **changes)


def timed(path: PathIR) -> TrajectoryIR:
    outcome = ParameterizeTime().run(path, PassContext())
    assert outcome.diagnostics == ()
    assert outcome.value is not None
    return outcome.value


def faults(path: PathIR) -> tuple[Diagnostic, ...]:
    outcome = ParameterizeTime().run(path, PassContext())
    assert outcome.value is None
    assert all(d.code in registry() for d in outcome.diagnostics)
    return outcome.diagnostics


def shot_time(leg: PathLeg, of: MissionIR | None = None) -> float:
    start, end = shot_phase(timed(flight(of or mission(), leg)))
    return end - start


def number_before(text: str, mark: str, after: str = "") -> float:
    """The number that stands right before a mark, after another."""
    text = text[text.index(after) + len(after) :] if after else text
    return float(text[: text.index(mark)].split()[-1].strip("`"))


def still(ir: TrajectoryIR, start: float, end: float) -> bool:
    at = ir.drones[0].curve(np.linspace(start, end, 20))
    return float(np.abs(at - at[0]).max()) < 1e-9


def resting(ir: TrajectoryIR, x: float) -> tuple[float, float]:
    """When the drone arrives at and leaves a place on the x axis where it holds, from the pieces."""
    curve = ir.drones[0].curve
    held = [i for i, c in enumerate(curve.ctrl) if np.ptp(c, axis=0).max() == 0 and abs(c[0, 0] - x) < 1e-6]
    return float(curve.breaks[held[0]]), float(curve.breaks[held[-1] + 1])
