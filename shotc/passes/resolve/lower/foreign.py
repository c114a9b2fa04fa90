"""Shot kinds of other packages: what they raise or return wrongly is reported as their fault."""

from collections.abc import Iterator
from math import isfinite
from typing import Any

from shotc.diag.model import Diagnostic
from shotc.diag.plugin_faults import plugin_failed
from shotc.ir.mission import Ideal, Keyframe, Subject
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.spec.shot import ShotBase


def expanded(kind: Kind, shot: ShotBase, scene: Scene) -> Expansion:
    """Return the expansion of a shot by a kind of another package, or P008 on the line of the kind."""
    try:
        expansion: Any = kind.expand(shot, scene)
        wrong = _wrong(expansion)
    except Exception as fault:  # noqa: BLE001  a plugin may raise anything
        return _refused(kind, scene, fault)
    return _refused(kind, scene, wrong) if wrong else expansion


def _refused(kind: Kind, scene: Scene, fault: Exception | str) -> Expansion:
    label = scene.origins.value((*scene.path, "kind"))
    return Expansion(diagnostics=(plugin_failed(f"kind `{kind.name}`", kind.package, fault, label),))


def _wrong(result: Any) -> str:
    """Return what is wrong with the form of an expansion; an empty text if nothing is."""
    if not isinstance(result, Expansion):
        return f"returned a {type(result).__name__}, not an Expansion"
    parts: Any = ((result.keyframes, Keyframe), (result.subjects, Subject), (result.diagnostics, Diagnostic))
    for items, record in parts:
        if not isinstance(items, tuple) or not all(isinstance(item, record) for item in items):
            return f"returned something else than {record.__name__}s in a tuple"
    ideal: Any = result.ideal
    if not isinstance(ideal, Ideal | None):
        return f"returned a {type(ideal).__name__} as its ideal"
    if not all(isfinite(number) for number in _numbers((result.keyframes, result.ideal, result.duration))):
        return "returned a number that is not finite"
    if not (result.keyframes or result.ideal or result.display or result.diagnostics or result.deferred):
        return "returned no keyframe, and does not say why"
    return ""


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _numbers(item)
