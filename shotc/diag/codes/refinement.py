"""R: refinement."""

from __future__ import annotations

from shotc.diag.model import Severity
from shotc.diag.registry import CodeInfo

CODES: tuple[CodeInfo, ...] = (
    CodeInfo(
        "R001",
        "refiner-failed",
        Severity.ERROR,
        "the refiner raised",
        "A refiner is a plugin that improves the filmed legs of the convex path. This one stopped with an exception, "
        "so there is no refined path. Plan with another one (`shotc list refiners`), with `--refiner none`, or let "
        "the mission accept the convex path by `refine: {optional: true}` in its shots.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R002",
        "refiner-broken-path",
        Severity.ERROR,
        "the refiner returned something that is not a flyable path",
        "What a refiner returns is checked: the same legs, joined end to end, at rest where the convex path rests, "
        "finite numbers. This one broke a rule. Report it to the plugin's author; plan with another refiner meanwhile.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R003",
        "refinement-skipped",
        Severity.WARNING,
        "the refiner gave nothing usable and the mission accepts the convex path",
        "Every shot of the mission says `refine: {optional: true}`, so the convex path is flown where the refiner "
        "fails. It is verified like any other path; only the framing between keyframes may be worse.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R010",
        "solver-not-a-number",
        Severity.ERROR,
        "the refiner's solver came to values that are not numbers",
        "A step of the solver led to where the problem has no value, such as a camera straight above its target, whose "
        "heading means nothing. The stage, its time and the constraint that was worst in the last step that had numbers "
        "are named. Move the keyframes there apart from what is named, let the shot fly its convex path by `refine: "
        "{optional: true}`, or plan with `--refiner none`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R011",
        "solver-stopped-early",
        Severity.ERROR,
        "the refiner's solver stopped before it had a path",
        "The solver reached its limit of iterations or of time. What it had by then breaks a constraint, so it is not "
        "used: the stage, its time, the constraint that was worst and by how much are named. A limit that is barely "
        "met, or keyframes that ask for a sharp turn, make a problem slow. Loosen what is named or add a keyframe "
        "there, let the shot fly its convex path by `refine: {optional: true}`, or plan with `--refiner none`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R012",
        "refinement-impossible",
        Severity.ERROR,
        "no path near the convex one keeps all constraints of the refiner's problem",
        "The solver found that near the convex path the constraints contradict one another. The stage, its time and the "
        "constraint that could be met least are named, with the number by which it was broken. Loosen it or move the "
        "keyframes beside it, let the shot fly its convex path by `refine: {optional: true}`, or plan with `--refiner "
        "none`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R013",
        "second-solver-used",
        Severity.WARNING,
        "a shot was refined by the second solver, since the first did not converge",
        "A refiner may have a solver that is fast and one that is robust. Where the first gives up the second is tried, "
        "and this says so. The plan is proved as any other; planning took longer.",
        "",
        "",
        "other",
    ),
)
