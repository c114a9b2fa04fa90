"""check: what can be told of a mission without a solver.

Apart from ``api``, for editors and hooks check at every save, and most of the time is loading.
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
    """What is wrong with one mission text, and the texts that the diagnostics point into."""

    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]


def check_source(data: bytes, name: str, folder: Path | KeptFiles | None) -> CheckReport:
    """Check one mission without a solver.

    data : any bytes; name : how to show it; folder : where the files that it names are, or these
    """
    kinds = plugins.shot_kinds()
    loaded = load(data, name, folder, models_of(kinds.plugins), kinds.unusable)
    found = [*loaded.diagnostics]
    if loaded.mission is not None:
        passes = passes_of(FRONT, PassSettings(kinds.plugins, plugins.names("emitters")))
        found += run(passes, loaded.mission, PassContext()).diagnostics
    return CheckReport(tuple(found), {name: loaded.file})


def models_of(kinds: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the model of every kind, each made when it is first asked for."""
    return plugins.OnDemand(kinds, lambda name: kinds[name].model)
