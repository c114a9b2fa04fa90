"""File names made of the names that people give."""

import re
from unicodedata import normalize

MAX_BYTES = 120
"""Bytes of a name in UTF-8: file systems take 255, and an ending is still to come."""

RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?").fullmatch
"""Names that Windows keeps for devices."""


def file_name(title: str) -> str:
    """Return a name for a file or a folder: letters and digits of any script, `-`, `_` and `.`."""
    name = re.sub(r"[^\w.-]+", "-", normalize("NFC", title)).lstrip(".-")
    name = name.encode()[:MAX_BYTES].decode(errors="ignore").rstrip(".-")
    return f"mission-{name}".rstrip("-") if not name or RESERVED(name) else name
