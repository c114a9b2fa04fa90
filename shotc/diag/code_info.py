"""The entry of a code in the registry: slug, severity, explanation and the examples that tests run."""

from typing import Literal, NamedTuple

from shotc.diag.model import Severity


class CodeInfo(NamedTuple):
    """What ``shotc explain`` prints about one code.

    phase    : the command that finds it; ``other`` if a mission alone cannot show it
    failing  : a mission (or its bytes, backslash-escaped, for Y codes) that raises the code
    passing  : the same mission without the fault
    exact    : codes under which ``plan`` reports the same fault with exact numbers, if this code only knows a
               bound; planning continues after this code to find them
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
