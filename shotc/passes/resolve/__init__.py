"""resolve: LoadedMission to MissionIR.

Takes a mission whose shape is right. Gives every name, preset, unit, place and kind resolved, and
reports all that can be told without a solver. A fault silences only what depends on it: geometry and
timing are judged once all names and places stand.
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

    kinds : every shot kind that is installed, by name
    emitters : names of the emitters that are installed, or None where that is not known
    """

    name: ClassVar[str] = "resolve"

    def __init__(self, kinds: Mapping[str, Kind], emitters: Collection[str] | None = None) -> None:
        self.kinds: Final = kinds
        self.emitters: Final = emitters

    def run(self, ir: LoadedMission, ctx: PassContext) -> Outcome[MissionIR]:
        """Resolve one mission."""
        what = lowered(ir, self.kinds, self.emitters, ctx.progress)
        faults = check(ir, what)
        return Outcome(None if what.astray or stops(faults) else what.mission, tuple(faults))
