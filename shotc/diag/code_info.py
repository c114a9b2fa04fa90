"""What is known of a code: slug, severity, explanation and the examples that tests run."""

from typing import Literal, NamedTuple

from shotc.diag.model import Severity


class CodeInfo(NamedTuple):
    """What ``shotc explain`` prints about one code.

    phase    : the command that finds it; ``other`` where a mission alone cannot show it
    failing  : a mission (or its bytes, backslash-escaped, for Y codes) that raises the code
    passing  : the same mission mended
    exact    : codes under which ``plan`` tells the same fault with exact numbers, where this one knows a
               bound only; planning goes on past it to find them
    """

    code: str
    slug: str
    severity: Severity
    summary: str
    explanation: str
    failing: str
    passing: str
    phase: Literal["check", "plan", "other"] = "check"
    since: str = "0.1"
    exact: tuple[str, ...] = ()
