"""What hides a target that is not visible throughout its shot, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.geom.pieces import Mask
from shotc.ir.occlusion import hiders, others_of
from shotc.ir.parked import bodies
from shotc.ir.sampling import clock, framed
from shotc.ir.trajectory import Claim, TrajectoryIR


def hidden_by(ir: TrajectoryIR, claim: Claim, target: str) -> Iterator[str]:
    """Yield what hides the target of a claim in its shot, the worst first, with its share of the frames."""
    mission = ir.keyframes.mission
    (track,) = (track for track in ir.drones if track.drone == claim.subject)
    ticks = clock(mission.rate, track.curve.end)
    times = ticks[framed(track, str(claim.shot), target, ticks)]
    if not len(times):
        return
    others, eyes = others_of(bodies(ir), track.drone), track.curve(times)[:, :3]
    shares = [(float(hides.mean()), name) for name, hides in hiders(mission, others, target, eyes, times)]
    for share, what in sorted(shares, key=lambda pair: -pair[0]):
        sort, _, name = what.partition(" ")
        if share > 0:
            yield f"{sort} `{name}` hides it in {100 * share:.3g} %"


def longest(hidden: Mask) -> int:
    """Return the sample in the middle of the longest run of hidden ones; 0 where none is."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], hidden, [False]]).astype(np.int8)))
    if not len(edges):
        return 0
    starts, ends = edges[::2], edges[1::2]
    k = int((ends - starts).argmax())
    return int((starts[k] + ends[k] - 1) // 2)
