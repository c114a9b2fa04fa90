"""Convert names of other tools to names of the language."""

from __future__ import annotations

import re

LONGEST_NAME_CHARACTERS = 40


def safe(name: str, otherwise: str = "mission") -> str:
    """Return a name of letters, digits and `-`, or ``otherwise`` if none of these is left."""
    words = re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:LONGEST_NAME_CHARACTERS].strip("-")
    return words or otherwise
