"""A comparison as JSON; without measured times, the same mission gives the same text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from shotc import __version__
from shotc.diag.model import Diagnostic
from shotc.ir.comparison import ComparedShot, Comparison, Condition
from shotc.planfile import layout
from shotc.planfile.codec import encode

FORMAT, VERSION = "shotc-compare", 1


def json_text(comparison: Comparison, *, seconds: bool) -> str:
    """Return the document.

    An error on screen is "inf" if it includes frames with the target behind the camera.

    seconds : whether to include the time that each refiner took
    """
    mission = comparison.mission
    return layout.text(
        {
            "format": FORMAT,
            "version": VERSION,
            "tool": {"name": "shotc", "version": __version__},
            "source": {"file": mission.origins.file, "sha256": mission.source_sha256},
            "mission": mission.name,
            "refiners": [_condition(each, seconds=seconds) for each in comparison.conditions],
            "differences": [each._asdict() for each in comparison.differences],
        }
    )


def _condition(each: Condition, *, seconds: bool) -> dict[str, Any]:
    return {
        "refiner": each.refiner,
        "package": each.package,
        "smoothing_s": each.smoothing,
        "planned": each.plan is not None,
        "faults": _diagnostic_documents(each.faults),
        "broken_promises": _diagnostic_documents(each.broken),
        "left_convex": _diagnostic_documents(each.convex),
        "all": None if each.score is None else _encoded(each.score._asdict()),
        "shots": [_shot(shot) for shot in each.shots],
    } | ({"refine_seconds": each.seconds} if seconds else {})


def _shot(shot: ComparedShot) -> dict[str, Any]:
    return {"shot": shot.id, "drone": shot.drone, "start": shot.start, "rounds": shot.rounds} | _encoded(
        shot.score._asdict()
    )


def _encoded(values: dict[str, Any]) -> dict[str, Any]:
    return {name: encode(value) for name, value in values.items()}


def _diagnostic_documents(diagnostics: Sequence[Diagnostic]) -> list[dict[str, Any]]:
    return [
        {"code": d.code, "message": d.message, "notes": list(d.notes), "help": d.help} for d in diagnostics
    ]
