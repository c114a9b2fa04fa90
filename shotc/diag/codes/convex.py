"""The codes of this family; see shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.model import Severity
from shotc.diag.registry import CodeInfo

_E, _W = Severity.ERROR, Severity.WARNING
CODES: tuple[CodeInfo, ...] = tuple(
    CodeInfo(code, slug, sev, slug, "", "", "", "plan")
    for code, slug, sev in (
        ("Q001", "no-way", _E),
        ("Q002", "pad-blocked", _E),
        ("Q003", "corridor-too-tight", _E),
        ("Q004", "point-too-near", _E),
        ("Q005", "body-cannot-follow", _E),
        ("Q006", "path-moved", _W),
        ("Q007", "framing-not-kept", _W),
        ("Q008", "solver-gave-up", _E),
    )
)
