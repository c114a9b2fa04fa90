"""What hides a target that is not visible throughout its shot, as notes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.coverage import coverage, covered_by_parts
from shotc.ir.framed import course_of
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.hiding_surfaces import NamedParts, parts_before
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import others_of
from shotc.ir.owners import mesh_owner
from shotc.ir.parked import bodies
from shotc.ir.phases import Phase
from shotc.ir.sampling import clock, framed
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.rounding import plain, up

MOST_NAMED = 3
"""Most buildings, or parts of a scene, that are named: those that hide the most."""


def hidden_by(ir: TrajectoryIR, claim: Claim, target: str) -> Iterator[str]:
    """Yield what hides the target of a claim in its shot, the worst first: how much of it, and how often."""
    mission = ir.keyframes.mission
    (track,) = (track for track in ir.drones if track.drone == claim.subject)
    ticks = clock(mission.rate, track.curve.end)
    times = ticks[framed(track, str(claim.shot), target, ticks)]
    if not len(times):
        return
    others, eyes = others_of(bodies(ir), track.drone), track.curve(times)[:, :3]
    named, shares = parts_before(mission, target), list[tuple[str, Array]]()
    for what, share in coverage(mission, others, target, eyes, times).by:
        parts = _by_name(mission, named[what], target, _Views(eyes, times, share)) if what in named else []
        if len(parts) != 1:
            sort, _, name = what.partition(" ")
            shares.append((f"{sort} `{name}`", share))
        shares += parts[:MOST_NAMED]
    for what, share in sorted(shares, key=lambda by: -by[1].sum()):
        if share.any():
            often = float((share > 1.0 - HALF_SHARE).mean())
            most = f"{what} hides up to {plain(up(100 * float(share.max()), 1))} % of it"
            yield f"{most}, and more than half in {100 * often:.3g} % of the frames"


def nowhere_seen(mission: MissionIR, phase: Phase) -> Iterator[str]:
    """Yield that a framing was tried from all round, if no place was found that shows its subjects."""
    shot = mission.shot(str(phase.shot))
    framed = shot.ideal is not None and shot.ideal.framed
    if framed and course_of(mission, shot, phase.start).lost > HALF_SHARE:
        what = "it" if len(shot.subjects) == 1 else "all subjects"
        yield f"places all round, as far as the framing leaves them free, were tried: none shows {what}"


class _Views(NamedTuple):
    """Eyes (M, 3), mission times (M,), and the share of a target that a whole mesh hides from them, (M,)."""

    eyes: Array
    times: Array
    share: Array


def _by_name(mission: MissionIR, of: NamedParts, target: str, views: _Views) -> list[tuple[str, Array]]:
    """Return the parts of a mesh that hide a target, by name, the worst first, and the share that each
    hides.
    """
    eyes, times, share = views
    hides, owner = share > 0.0, mesh_owner(of.mesh)
    if not hides.any():
        return []
    shares = []
    for name, its in covered_by_parts(mission, of, target, eyes[hides], times[hides]).by:
        every = np.zeros(len(share))
        every[hides] = its
        shares.append((owner._replace(name=name).words, every))
    return sorted(shares, key=lambda by: -by[1].sum())
