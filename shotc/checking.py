"""check: the diagnostics of a mission that need no solver.

It is separate from ``api``, because editors and hooks check at every save, and loading takes most of the
time.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from shotc import plugins
from shotc.diag.model import Diagnostic
from shotc.ir.passes import PassContext
from shotc.ir.source import KeptFiles
from shotc.pipeline import FRONT, PassSettings, passes_of, run
from shotc.source.file import SourceFile
from shotc.spec.load import load


class CheckReport(NamedTuple):
    """The diagnostics of one mission, and the texts that they refer to."""

    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]


def check_source(data: bytes, name: str, folder: Path | KeptFiles | None) -> CheckReport:
    """Check one mission without a solver.

    data : any bytes; name : in messages; folder : of the files that it names, or these files
    """
    kinds = plugins.shot_kinds()
    loaded = load(data, name, folder, models_of(kinds.plugins), kinds.unusable)
    diagnostics = [*loaded.diagnostics]
    if loaded.mission is not None:
        passes = passes_of(FRONT, PassSettings(kinds.plugins, plugins.names("emitters")))
        diagnostics += run(passes, loaded.mission, PassContext()).diagnostics
    return CheckReport(tuple(diagnostics), {name: loaded.file})


def models_of(kinds: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the model of every kind, each made at its first use."""
    return plugins.OnDemand(kinds, lambda name: kinds[name].model)
