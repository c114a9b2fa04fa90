"""What is being done, on a terminal."""

from __future__ import annotations

from typing import Any

from shotc.cli import console


class Progress:
    """Show what is running on a terminal; say nothing elsewhere."""

    def __init__(self) -> None:
        self._status: Any = None

    def __enter__(self) -> Any:
        terminal = console.stderr_console()
        if terminal.is_terminal and not console.is_quiet():
            self._status = terminal.status("reading")
            self._status.start()
        return self._say

    def __exit__(self, *_: object) -> None:
        if self._status is not None:
            self._status.stop()

    def _say(self, message: str) -> None:
        if self._status is not None:
            self._status.update(message)
