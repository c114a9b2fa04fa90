"""File names from titles."""

import re
from unicodedata import normalize

MAX_BYTES = 120
"""Most bytes of a name in UTF-8; file systems allow 255, with the ending."""

RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?").fullmatch
"""Names that Windows reserves for devices."""


def file_name(title: str) -> str:
    """Return a name for a file or a folder with letters and digits of any script, `-`, `_` and `.`."""
    name = re.sub(r"[^\w.-]+", "-", normalize("NFC", title)).lstrip(".-")
    name = name.encode()[:MAX_BYTES].decode(errors="ignore").rstrip(".-")
    return f"mission-{name}".rstrip("-") if not name or RESERVED(name) else name
