"""resolve: LoadedMission to MissionIR.

It takes a mission of valid form. It resolves every name, preset, unit, place and kind, and reports all faults
that need no solver. A fault suppresses only the checks that depend on it: geometry and timing are checked
when all names and places are resolved.
"""

from collections.abc import Collection, Mapping
from typing import ClassVar, Final

from shotc.diag.registry import stops
from shotc.ir.mission import MissionIR
from shotc.ir.passes import Outcome, PassContext
from shotc.kinds.base import Kind
from shotc.passes.resolve.checks import check
from shotc.passes.resolve.lower import lowered
from shotc.spec.load import LoadedMission


class Resolve:
    """The pass.

    kinds : every installed shot kind, by name
    emitters : names of the installed emitters, or None where these are not known
    """

    name: ClassVar[str] = "resolve"

    def __init__(self, kinds: Mapping[str, Kind], emitters: Collection[str] | None = None) -> None:
        self.kinds: Final = kinds
        self.emitters: Final = emitters

    def run(self, ir: LoadedMission, ctx: PassContext) -> Outcome[MissionIR]:
        """Resolve one mission."""
        partial = lowered(ir, self.kinds, self.emitters, ctx.progress)
        faults = check(ir, partial)
        return Outcome(None if partial.unplaced or stops(faults) else partial.mission, tuple(faults))
