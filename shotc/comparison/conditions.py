"""One mission under one refiner: refined, timed, verified and measured."""

from __future__ import annotations

from dataclasses import replace

from shotc import plugins
from shotc.comparison.score import flown_shots, total
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.comparison import Condition
from shotc.ir.mission import Shot
from shotc.ir.passes import PassContext
from shotc.ir.path import PathIR
from shotc.ir.promise import Promise
from shotc.ir.trajectory import TrajectoryIR, VerifiedIR
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.passes.refine_path import RefinePath, Seat
from shotc.passes.verify import Verify, judge
from shotc.passes.verify.promises import PROMISES
from shotc.pipeline import run

KEPT_CONVEX = "R003"


def condition(name: str, path: PathIR, deadline: float | None, ctx: PassContext) -> Condition:
    """Return the mission under a refiner, from its convex path on.

    deadline : seconds for the refiner, as in planning
    """
    source = plugins.one("refiners", name)
    if source.plugin is None:
        return Condition(name, source.package, None, source.diagnostics)
    seat = Seat(source.plugin, source.package, source.reference)
    # Keeping the path takes no time; a deadline would start a process to watch it.
    limit = None if name == plugins.NO_REFINER else deadline
    lowered = run((RefinePath(seat, limit), ParameterizeTime()), path, ctx)
    seconds = lowered.reports[0].seconds
    if lowered.value is None or has_errors(lowered.diagnostics):
        return Condition(name, source.package, None, _errors(lowered.diagnostics), seconds=seconds)
    plan, faults = _proved(lowered.value, ctx)
    broken = tuple(d for d in faults if d.code in PROMISES)
    if plan is None:
        refused = tuple(d for d in faults if d.code not in PROMISES)
        return Condition(name, source.package, None, refused, broken, seconds=seconds)
    shots = flown_shots(plan)
    convex = tuple(d for d in lowered.diagnostics if d.code == KEPT_CONVEX)
    return Condition(name, source.package, plan, (), broken, convex, shots, total(plan, shots), seconds)


def _proved(ir: TrajectoryIR, ctx: PassContext) -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    """Return the plan if all limits hold, and the faults of limits and promises."""
    faults = _errors(judge(ir, ctx).diagnostics)
    if any(d.code not in PROMISES for d in faults):
        return None, faults
    return Verify().run(unpromised(ir), ctx).value, faults


def unpromised(ir: TrajectoryIR) -> TrajectoryIR:
    """Return the trajectory of the same mission without promises on framing."""

    def free(shot: Shot) -> Shot:
        return shot._replace(promise=Promise())

    keyframes = ir.keyframes
    mission = keyframes.mission._replace(shots=tuple(map(free, keyframes.mission.shots)))
    shots = tuple(placed._replace(shot=free(placed.shot)) for placed in keyframes.shots)
    return replace(ir, keyframes=keyframes._replace(mission=mission, shots=shots))


def _errors(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    return tuple(d for d in diagnostics if has_errors([d]))
