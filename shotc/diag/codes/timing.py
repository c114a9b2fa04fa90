"""The codes of this family; see shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.registry import CodeInfo

CODES: tuple[CodeInfo, ...] = ()
