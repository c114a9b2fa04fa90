"""The result of the front passes, which need no solver. Plain Python."""

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.keyframes import KeyframeIR
from shotc.source.file import SourceFile


class Lowered(NamedTuple):
    """The lowered mission, or the diagnostics that stopped its lowering.

    file : its text, which the diagnostics refer to
    """

    keyframes: KeyframeIR | None
    diagnostics: tuple[Diagnostic, ...]
    file: SourceFile
