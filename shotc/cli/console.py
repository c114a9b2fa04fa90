"""Functions that all commands share: exit codes, colour, output streams, tables, progress, option names.

Results go to standard output, messages to standard error. The application's callback calls ``configure``
once; commands only call ``out``, ``note``, ``report`` and ``exit_code``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from enum import StrEnum
from typing import TYPE_CHECKING, Any, TextIO

import typer

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import has_errors, severity_of
from shotc.source.file import SourceFile

if TYPE_CHECKING:
    from rich.console import Console


EXIT_CLEAN = 0
EXIT_REJECTED = 1
EXIT_USAGE = 2
EXIT_BUG = 70
EXIT_INTERRUPTED = 130


class Color(StrEnum):
    """When to colour what is printed."""

    AUTO = "auto"
    ALWAYS = "always"
    NEVER = "never"


class _Settings:
    """The global flags of this process."""

    color: Color = Color.AUTO
    quiet: bool = False


_settings = _Settings()


def configure(color: Color = Color.AUTO, *, quiet: bool = False) -> None:
    """Store the global flags for the rest of this process."""
    _settings.color = color
    _settings.quiet = quiet


def is_quiet() -> bool:
    """Return whether only findings and results are printed (``--quiet``)."""
    return _settings.quiet


def colored(stream: TextIO) -> bool:
    """Return whether ``stream`` gets colour: the flag, then NO_COLOR, FORCE_COLOR, TERM, then the
    terminal.
    """
    if _settings.color is not Color.AUTO:
        return _settings.color is Color.ALWAYS
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return os.environ.get("TERM") != "dumb" and stream.isatty()


def out(text: str) -> None:
    """Write a result to standard output, ending in one line end."""
    _write(sys.stdout, text)


def note(text: str) -> None:
    """Write a message to standard error, unless the run is quiet."""
    if not _settings.quiet:
        _write(sys.stderr, text)


def complain(text: str) -> None:
    """Write a message to standard error, even if the run is quiet."""
    _write(sys.stderr, text)


def report(
    diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile], stream: TextIO | None = None
) -> None:
    """Print diagnostics as text, with a summary line, to ``stream`` (standard error when not given).

    A quiet run shows errors, but no warnings.
    """
    stream = stream or sys.stderr
    printed = [d for d in diagnostics if not _settings.quiet or severity_of(d) is Severity.ERROR]
    if printed:
        from shotc.diag.render.text import render

        _write(stream, render(printed, sources, color=colored(stream)))


def exit_code(diagnostics: Iterable[Diagnostic]) -> int:
    """Return 1 if a diagnostic rejects the mission, else 0: a warning never changes the exit status."""
    return EXIT_REJECTED if has_errors(diagnostics) else EXIT_CLEAN


def stderr_console() -> Console:
    """Return a rich console on standard error for progress. It prints nothing if that is not a terminal."""
    from rich.console import Console

    return Console(stderr=True, quiet=_settings.quiet, no_color=not colored(sys.stderr), highlight=False)


def _write(stream: TextIO, text: str) -> None:
    """Write ``text`` with one line end. Characters that the stream cannot encode become escapes."""
    line = text if text.endswith("\n") else text + "\n"
    try:
        stream.write(line)
    except UnicodeEncodeError:
        encoding = stream.encoding or "ascii"
        stream.write(line.encode(encoding, "backslashreplace").decode(encoding))


def table(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return rows as lines of text, with two spaces between columns."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]


class Progress:
    """Show the running step on a terminal; print nothing elsewhere."""

    def __init__(self) -> None:
        self._status: Any = None

    def __enter__(self) -> Any:
        terminal = stderr_console()
        if terminal.is_terminal and not is_quiet():
            self._status = terminal.status("reading")
            self._status.start()
        return self._say

    def __exit__(self, *_: object) -> None:
        if self._status is not None:
            self._status.stop()

    def _say(self, message: str) -> None:
        if self._status is not None:
            self._status.update(message)


def listed(names: str | None) -> list[str] | None:
    """Return the names of a comma-separated list, each once; None if there is no list."""
    if names is None:
        return None
    return list(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))


def known(option: str, name: str | None, names: list[str]) -> None:
    """Raise a usage error if ``name`` is unknown; the message gives the nearest known name."""
    if name is None or name in names:
        return
    near = get_close_matches(name, names, 1)
    hint = f"did you mean `{near[0]}`?" if near else f"known: {', '.join(names)}"
    raise typer.BadParameter(f"`{name}` is unknown; {hint}", param_hint=option)
