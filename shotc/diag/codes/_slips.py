"""Helper for codes whose example is a writing error: a passing mission, and the same one with the error."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

LOOK = """\
shotc: 1
mission: look
world:
  wind: 3 m/s
  zones:
    tree: {keep: out, cylinder: {center: [-30, 20], radius: 3, height: [0, 12]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0], camera: {hfov: 70 deg, aspect: "16:9"}}
rules: {composition: thirds, pace: calm}
shots:
  - {id: wide, kind: static, drone: cam1, target: tower, at: [0, -50, 15], look_at: tower, timing: {duration: 5}}
"""
"""A small mission with one of each part that authors write by hand."""


def slip(
    code: str, slug: str, summary: str, explanation: str, passing: str, *changes: tuple[str, str]
) -> CodeInfo:
    """Return an error of ``check``. Its failing mission is the passing one with every change (right, wrong).

    Raises ValueError if the text to change is not in the passing mission: such an example would not fail.
    """
    failing = passing
    for right, wrong in changes:
        if right not in failing:
            raise ValueError(f"{code}: the passing mission does not hold {right!r}")
        failing = failing.replace(right, wrong)
    return CodeInfo(code, slug, Severity.ERROR, summary, explanation, failing, passing)
