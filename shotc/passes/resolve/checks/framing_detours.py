"""Why a framing is another than the one of least cost: what hides its subjects there, or is in the way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from shotc.geom.vec import Vec3
from shotc.ir.allow import HIDDEN
from shotc.ir.framed_course import StartedFraming, eyes_of
from shotc.ir.framed_scene import FramedScene
from shotc.ir.hidden import hides, lacks
from shotc.ir.mission import MissionIR, Shot, Subject
from shotc.passes.resolve.checks.framing_remedies import Fits


def why_not_direct(mission: MissionIR, course: StartedFraming) -> Iterator[str]:
    """Yield a note on what a course avoids, if it is not the one of least cost."""
    if course.avoided is None:
        return
    direct = course.avoided
    eyes = eyes_of(direct.times, direct.poses)
    if direct.blocked >= 1.0:
        t, eye = eyes[0]
        owner, lack = max(lacks(mission, mission.drone(direct.shot.drone), eye, t), key=lambda one: one[1])
        yield f"where all appear as asked the camera has no room: {owner.words} lacks {lack:.2f} m"
        return
    lost = ((_lost(mission, direct.shot, one, eyes), one) for one in direct.shot.subjects)
    share, subject = max(lost, key=lambda pair: pair[0])
    named = (hides(mission, subject.target, eye, t) for t, eye in eyes)
    by = Counter(name for name in named if name is not None).most_common(1)
    yield (
        f"where all appear as asked, `{by[0][0]}` hides more than half of `{subject.target}` in "
        f"{100 * share:.0f} % of the shot"
    )


def for_hidden(fits: Fits, mission: MissionIR, course: StartedFraming) -> Iterator[str]:
    """Yield the key that accepts hidden subjects, if all appear as asked then."""
    shot = course.asked
    if course.avoided is not None and fits(mission, shot._replace(allow=(*shot.allow, HIDDEN))):
        yield f"write `allow: [{HIDDEN}]` in the shot to accept hidden subjects"


def _lost(mission: MissionIR, shot: Shot, subject: Subject, eyes: Sequence[tuple[float, Vec3]]) -> float:
    """Return the share of times and places from which at least half of one subject is hidden."""
    return FramedScene(mission, shot._replace(subjects=(subject,)), eyes[0][0]).lost(eyes)
