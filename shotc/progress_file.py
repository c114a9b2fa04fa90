"""The progress of long work that may be killed: a file with one JSON line an entry, removed at the end.

An incomplete line is ignored.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class ProgressFile:
    """The entries in a file; each is an object with a text ``key``."""

    path: Path

    def entries(self) -> Iterator[dict[str, Any]]:
        """Yield the entries; none if the file cannot be read."""
        try:
            lines = self.path.read_text(encoding="ascii").splitlines()
        except (OSError, ValueError):
            return
        for line in lines:
            with suppress(ValueError):
                entry = json.loads(line)
                if isinstance(entry, dict) and isinstance(entry.get("key"), str):
                    yield entry

    def add(self, key: str, entry: dict[str, Any]) -> None:
        """Store an entry; ignore a failure of the disk."""
        with suppress(OSError):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("a", encoding="ascii") as stream:
                stream.write(json.dumps({"key": key, **entry}) + "\n")

    def forget(self) -> None:
        """Remove the file."""
        with suppress(OSError):
            self.path.unlink(missing_ok=True)
