"""What hides a target that is not visible throughout its shot, in words."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.ir.coverage import HALF_SHARE, coverage
from shotc.ir.occlusion import others_of
from shotc.ir.parked import bodies
from shotc.ir.sampling import clock, framed
from shotc.ir.trajectory import Claim, TrajectoryIR


def hidden_by(ir: TrajectoryIR, claim: Claim, target: str) -> Iterator[str]:
    """Yield what hides the target of a claim in its shot, the worst first: how much of it, and how often."""
    mission = ir.keyframes.mission
    (track,) = (track for track in ir.drones if track.drone == claim.subject)
    ticks = clock(mission.rate, track.curve.end)
    times = ticks[framed(track, str(claim.shot), target, ticks)]
    if not len(times):
        return
    others, eyes = others_of(bodies(ir), track.drone), track.curve(times)[:, :3]
    for what, share in sorted(coverage(mission, others, target, eyes, times).by, key=lambda by: -by[1].sum()):
        sort, _, name = what.partition(" ")
        if share.any():
            often = float((share > 1.0 - HALF_SHARE).mean())
            most = f"{sort} `{name}` hides up to {100 * share.max():.3g} % of it"
            yield f"{most}, and more than half in {100 * often:.3g} % of the frames"
