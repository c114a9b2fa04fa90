"""Check that the pictures of fleets that cameras film stand during these shots."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.diag.model import Diagnostic
from shotc.ir.fleet import standing
from shotc.ir.phases import Phase
from shotc.ir.tolerances import ON_TIME_S
from shotc.ir.trajectory import TrajectoryIR
from shotc.rounding import at_least, plain


def not_standing(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Yield the shots that film a picture before it stands, or after it."""
    if ir.fleets:
        flown = [phase for track in ir.drones for phase in track.phases if phase.shot is not None]
        yield from (fault for phase in flown if (fault := _astray(ir, phase)) is not None)


def _astray(ir: TrajectoryIR, phase: Phase) -> Diagnostic | None:
    mission = ir.keyframes.mission
    shot = mission.shot(phase.shot)
    stand = standing(mission, ir.fleets, shot.subject)
    if stand is None:
        return None
    early, late = stand.start - phase.start, phase.end - stand.end
    if max(early, late) <= ON_TIME_S:
        return None
    parts = [f"{at_least(early)} s before it stands"] if early > ON_TIME_S else []
    parts += [f"{at_least(late)} s after it has left"] if late > ON_TIME_S else []
    origins, pictures = mission.origins, mission.display(stand.display).pictures
    picture, later = pictures[stand.picture], pictures[stand.picture + 1 :]
    help_ = f"give the shot `duration: {plain(stand.end - stand.start)}` or less"
    if early > ON_TIME_S or phase.start >= stand.end > stand.start:
        help_ = "leave out `start` and `after` of the shot: it begins when the picture stands"
    elif stand.end > stand.start and all(p.at is None for p in later):
        help_ += f", or the picture `hold: {at_least(phase.end - stand.start)}`"
    return Diagnostic(
        "V058",
        f"shot `{shot.id}` films `{shot.subject}` {' and '.join(parts)}",
        (origins.key(shot.path), origins.value((*picture.path, "name"), "the picture")),
        (f"it stands from {plain(stand.start)} to {plain(stand.end)} s",),
        help_,
    )
