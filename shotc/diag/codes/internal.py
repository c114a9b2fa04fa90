"""X: bugs of shotc itself. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

CODES: tuple[CodeInfo, ...] = (
    CodeInfo(
        code="X001",
        slug="internal-error",
        severity=Severity.ERROR,
        summary="shotc failed; this is our bug",
        explanation=(
            "Something happened that shotc does not foresee. The mission may be right or wrong: either way the "
            "compiler owes a diagnostic, not a failure. No output was changed. Run the same command again with "
            "SHOTC_DEBUG=1 to see where it happened, and report that text with the mission and the line that "
            "'shotc --version' prints. The exit status is 70."
        ),
        failing="",
        passing="",
        phase="other",
    ),
)
