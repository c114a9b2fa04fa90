"""R: refinement."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

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
        "The result of a refiner is checked: legs joined end to end, at rest where the convex path rests, "
        "finite numbers, no jump of place, angle or of their first two derivatives. This one broke a rule. "
        "It is a fault of the package that is named: tell its authors, and plan with another refiner "
        "meanwhile, or let the shot accept its convex path by `refine: {optional: true}`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R003",
        "refinement-skipped",
        Severity.WARNING,
        "the refiner failed in a shot that accepts its convex path",
        "The shot says `refine: {optional: true}`, so its convex path is flown where the refiner fails, and the other "
        "shots stay refined. What was wrong is in the notes. The path is verified like any other; only the framing "
        "between keyframes may be worse.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R004",
        "refiner-too-slow",
        Severity.ERROR,
        "the refiner did not answer within the deadline",
        "`--deadline SECONDS` lets the refiner run in a process of its own, which is stopped for good when its time is "
        "up, whatever it is doing; loading its libraries counts. Give it longer, plan with another refiner or with "
        "`--refiner none`, or let the shots accept their convex paths by `refine: {optional: true}`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R005",
        "refiner-changed-mission",
        Severity.ERROR,
        "the refiner changed something that the mission decides",
        "A refiner may move the camera between keyframes. The mission decides the rest: the shots and "
        "their order, their durations, pace, holds, keyframes and fixed times, the targets that they "
        "frame, and the places of these on screen. Take-off and landing are at home. This refiner handed "
        "back a path for another mission. It is a fault of the package that is named: tell its authors, "
        "and plan with another refiner meanwhile.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R006",
        "refined-path-too-near",
        Severity.ERROR,
        "the refined path comes too near to a zone, a target or the ground",
        "Every filmed leg and every way between shots has to keep its clearances at every point, not only "
        "at the solver's stages. The refined path does not; the message says to what it comes too near, "
        "where, and by how much. The refiner should have kept it, so tell the authors of the package that "
        "is named; more room between the keyframes and what stands there avoids it meanwhile, and so do "
        "another refiner and `refine: {optional: true}`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R007",
        "refined-keyframe-missed",
        Severity.ERROR,
        "the refined path misses a keyframe that the mission places",
        "A position that the user writes is binding, to a millimetre. The refined path passes it at the "
        "distance in the message. It is a fault of the package that is named: tell its authors, and plan "
        "with another refiner meanwhile, or let the shot accept its convex path by `refine: {optional: "
        "true}`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R008",
        "refined-gimbal-out-of-range",
        Severity.ERROR,
        "the refined path points the camera where the gimbal cannot",
        "The gimbal's pitch is measured against the horizon, its yaw against the body; both have to stay "
        "in the range of the mission at every point. The refined path leaves it; the message gives the "
        "axis, the place and the amount. It is a fault of the package that is named: tell its authors, and "
        "plan with another refiner meanwhile, or let the shot accept its convex path by `refine: "
        "{optional: true}`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "R009",
        "refined-path-refused",
        Severity.ERROR,
        "the refined path cannot be flown, but the convex one can",
        "A later pass refuses the refined path: it takes longer than the duration asked, or breaks a limit "
        "or a promise. The convex path, which was tried instead, does not. So the refiner is at fault; the "
        "notes say what it broke. Plan with another refiner or with `--refiner none`, loosen what is "
        "named, or let all shots accept their convex paths by `refine: {optional: true}`.",
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
        "The solver reached its limit of iterations or of time. The unfinished result is not used. Where "
        "it breaks a constraint, the stage, its time, the constraint that was worst and by how much are "
        "named. A limit that is barely met, or keyframes that ask for a sharp turn, make a problem slow. A "
        "note says whether the convex path would do, and how to keep it, by `refine: {optional: true}` in "
        "the shot or by `--refiner none`.",
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
    CodeInfo(
        "R014",
        "shot-not-refined",
        Severity.WARNING,
        "a shot stays on its convex path",
        "A refiner improves the filmed legs of the convex path where it can. This shot stays as it was, "
        "for the reason in the message: the refined path would come too near to something that moves or "
        "into another drone's picture, or would take longer than the flights beside it allow; the refiner "
        "found nothing better; or it does not refine shots of this kind. The plan is verified like any "
        "other.",
        "",
        "",
        "other",
    ),
)
