"""The ideals of shots on their own clock, for the earliest start of each shot."""

from __future__ import annotations

from shotc.ir.begins import first_start
from shotc.ir.framed import course_of
from shotc.ir.framed_course import StartedFraming
from shotc.ir.keyed import is_keyed, settled
from shotc.ir.mission import MissionIR


def with_times(mission: MissionIR) -> MissionIR:
    """Return the mission with the keyframes of such shots at their places when the camera is there."""
    shots = (
        settled(mission, shot, first_start(mission, shot)) if is_keyed(shot) else shot
        for shot in mission.shots
    )
    return mission._replace(shots=tuple(shots))


def with_framings(mission: MissionIR) -> tuple[MissionIR, tuple[StartedFraming, ...]]:
    """Return the mission with every framing's ideal and references, and the courses of the framings."""
    courses = []
    for i, shot in enumerate(mission.shots):
        if shot.ideal is None or not shot.ideal.framed:
            continue
        course = course_of(mission, shot, first_start(mission, shot))
        courses.append(course)
        shots = (*mission.shots[:i], course.shot, *mission.shots[i + 1 :])
        mission = mission._replace(shots=shots)
    return mission, tuple(courses)
