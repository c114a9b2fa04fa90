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
)
