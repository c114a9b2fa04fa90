"""The door to PyYAML, whose C parser reads missions."""

from __future__ import annotations

import re
from typing import Any

_LAST = chr(0x10FFFF)


class _Late:
    """A pattern that is compiled when something is first searched for by it."""

    def __init__(self, pattern: str) -> None:
        self._pattern = pattern

    def search(self, *arguments: Any) -> re.Match[str] | None:
        """Search as a compiled pattern does."""
        return re.compile(self._pattern).search(*arguments)


def _imported() -> Any:
    """Import PyYAML, with the pattern of its Python reader put off until that reader is used.

    The pattern spells out all of Unicode, and compiling it takes longer than checking a mission. The C
    parser, which is nearly always there, does without.
    """
    compiled = re.compile

    def patient(pattern: Any, flags: Any = 0) -> Any:
        whole = isinstance(pattern, str) and _LAST in pattern
        return _Late(pattern) if whole and not flags else compiled(pattern, flags)

    setattr(re, "compile", patient)  # noqa: B010  no type allows it, and it is put back at once
    try:
        import yaml
    finally:
        setattr(re, "compile", compiled)  # noqa: B010
    return yaml


yaml = _imported()
LOADER = getattr(yaml, "CLoader", yaml.Loader)
