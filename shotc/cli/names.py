"""Names that options are given: lists of them, and those that nobody knows."""

from __future__ import annotations

from difflib import get_close_matches

import typer


def listed(names: str | None) -> list[str] | None:
    """Return the names of a list with commas, each once; None where there is no list."""
    if names is None:
        return None
    return list(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))


def known(option: str, name: str | None, names: list[str]) -> None:
    """Reject an unknown name as a usage error with the nearest known one."""
    if name is None or name in names:
        return
    near = get_close_matches(name, names, 1)
    hint = f"did you mean `{near[0]}`?" if near else f"known: {', '.join(names)}"
    raise typer.BadParameter(f"`{name}` is unknown; {hint}", param_hint=option)
