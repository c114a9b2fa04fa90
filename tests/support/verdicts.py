"""What verification says of a plan, made once for each plan that a test asks several things about."""

from __future__ import annotations

from shotc.ir.passes import PassContext
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify import Verdict, judge

CONTEXT = PassContext()
KEPT = 8
_KEPT: list[tuple[TrajectoryIR, Verdict]] = []
"""The plans that were asked about last. They hold arrays and have no hash: each is known by being itself."""


def verdict_on(ir: TrajectoryIR) -> Verdict:
    """Return the verdict on a plan; the second time it is at hand."""
    found = next((verdict for plan, verdict in _KEPT if plan is ir), None) or judge(ir, CONTEXT)
    _KEPT[:] = [*(each for each in _KEPT if each[0] is not ir), (ir, found)][-KEPT:]
    return found


def codes(ir: TrajectoryIR) -> list[str]:
    """Return the codes of all that is told of a plan, each once, in order."""
    return sorted({d.code for d in verdict_on(ir).diagnostics})


def claim(ir: TrajectoryIR, constraint: str) -> Claim:
    """Return the first claim about a constraint."""
    return next(c for c in verdict_on(ir).certificate if c.constraint == constraint)
