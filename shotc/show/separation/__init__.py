"""keep-apart: ShowIR to TrajectoryIR.

Takes flights within their limits. Proves for every fleet that no two of its drones come nearer than its
separation, and that no two fleets meet. If this fails between two stops of a fleet, the drones concerned are
pushed apart, all at once and as little as necessary, until the proof and all limits hold. If that fails, the
error names the two drones, the time and their distance. Waves of departure are proved where they are made
(``show.assignment.waves``), so none is changed here. At the end the effects of lights are laid over the
places where the drones are flown.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.geom.apart import keeps_separation, straight_spacing
from shotc.geom.separation import closest_between
from shotc.ir.fleet import FleetTrajectory, ShowIR
from shotc.ir.mission import MissionIR
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.show import stricter
from shotc.ir.trajectory import TrajectoryIR
from shotc.show.assignment.images import images_of
from shotc.show.assignment.lights import laid_out_again
from shotc.show.separation.faults import bent, fleets_meet
from shotc.show.separation.later_start import later_start
from shotc.show.separation.off_goals import farthest
from shotc.show.separation.repair import Keeper

MUCH_SHARE = 0.5
"""Distance from a goal, as a share of the goals' spacing, above which a warning says that the picture is
deformed.
"""


@dataclass(frozen=True, slots=True)
class KeepApart:
    """The pass; it has no options."""

    name: ClassVar[str] = "keep-apart"

    def run(self, ir: ShowIR, ctx: PassContext) -> Outcome[TrajectoryIR]:
        """Prove every fleet's separation, and repair violations."""
        mission = ir.goals.keyframes.mission
        diagnostics: list[Diagnostic] = []
        warnings: list[Diagnostic] = []
        fleets, stats = [], list(ir.stats)
        for flight, reference in zip(ir.fleets, ir.wanted, strict=True):
            ctx.progress(f"separation in fleet {flight.fleet}")
            keeper = Keeper(mission, mission.fleet(flight.fleet), flight, reference, ctx)
            fleets.append(keeper.keep())
            diagnostics += keeper.faults
            stats += keeper.stats()
            off = farthest(fleets[-1], reference)
            stats += off.stats(flight.fleet)
            if off.distance > MUCH_SHARE * straight_spacing(keeper.fleet.apart):
                warnings.append(bent(mission, keeper.fleet, off))
        for one, other in combinations(fleets, 2):
            diagnostics += _meeting(mission, fleets, (one, other))
        if diagnostics:
            return Outcome(None, tuple(diagnostics))
        lit = tuple(_lit(mission, fleets))
        return Outcome(TrajectoryIR(ir.goals.keyframes, (), (), tuple(stats), lit), tuple(warnings))


def _lit(mission: MissionIR, fleets: list[FleetTrajectory]) -> Iterator[FleetTrajectory]:
    """Yield the fleets with the effects of their lights over the places where they are flown in the end."""
    images = images_of(mission)
    assert not isinstance(images, list), "assign-goals refuses an image that cannot be read"
    yield from (laid_out_again(mission, flight, images) for flight in fleets)


def _meeting(
    mission: MissionIR, every: list[FleetTrajectory], pair: tuple[FleetTrajectory, FleetTrajectory]
) -> list[Diagnostic]:
    one, other = pair
    fleets = mission.fleet(one.fleet), mission.fleet(other.fleet)
    apart = stricter(fleets[0].apart, fleets[1].apart)
    near = closest_between(one.breaks, one.coef, other.breaks, other.coef, apart)
    if keeps_separation(near.proven, apart.across):
        return []
    return [fleets_meet(mission, pair, near, apart.across, later_start(mission, every, pair))]
