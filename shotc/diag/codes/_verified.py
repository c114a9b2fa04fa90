"""Helper for codes of verification. Those without an example need an edited plan or a faulty plugin."""

from __future__ import annotations

from typing import Literal

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity


def verified(
    number: int,
    slug: str,
    text: tuple[str, str],
    examples: tuple[str, str] = ("", ""),
    severity: Severity = Severity.ERROR,
) -> CodeInfo:
    """Return the code with this number. ``text``: summary, explanation. ``examples``: failing, passing."""
    phase: Literal["plan", "other"] = "plan" if examples[0] else "other"
    return CodeInfo(f"V{number:03}", slug, severity, *text, *examples, phase)
