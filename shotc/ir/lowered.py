"""What comes of lowering a mission as far as that goes without a solver. Plain Python."""

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.keyframes import KeyframeIR
from shotc.source.file import SourceFile


class Lowered(NamedTuple):
    """What a mission asks for, or what keeps it from being lowered.

    file : its text, which the diagnostics point into
    """

    keyframes: KeyframeIR | None
    diagnostics: tuple[Diagnostic, ...]
    file: SourceFile
