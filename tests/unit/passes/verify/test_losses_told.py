"""Which losses of a target are reported: one warning for each, and none for what the author asks for."""

from __future__ import annotations

import pytest

from shotc.ir.mission import Subject
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.report import report
from tests.support.records import replace
from tests.support.tampered_plans import MISSION, PLAN, with_mission, with_shot
from tests.support.verdicts import claim

PLACES = MISSION.shots[0].keyframes[0].composition
SEEN = replace(claim(PLAN, "tower in sight"), holds=True, hard=False)
COVERED = replace(SEEN, constraint="tower visible", worst=0.4, holds=False)
HIDDEN = replace(SEEN, worst=0.2, holds=False)
CROPPED = replace(SEEN, constraint="tower in frame", worst=0.9, holds=False)


def told(ir: TrajectoryIR, *claims: Claim) -> list[str]:
    return [d.code for d in report(ir, claims)]


def test_a_target_that_is_covered_and_in_sight_is_told() -> None:
    assert told(PLAN, COVERED, SEEN) == ["V031"]


def test_a_target_hidden_in_most_frames_is_told_once() -> None:
    assert told(PLAN, COVERED, HIDDEN) == ["V050"]
    assert told(PLAN, SEEN, COVERED, HIDDEN) == ["V050"]


@pytest.mark.parametrize(
    "elsewhere",
    [
        replace(HIDDEN, shot="another"),
        replace(HIDDEN, constraint="mast in sight"),
        replace(HIDDEN, holds=True),
    ],
)
def test_another_loss_does_not_hide_the_one_of_a_target(elsewhere: Claim) -> None:
    shots = (*MISSION.shots, replace(MISSION.shots[0], id="another"))
    assert "V031" in told(with_mission(shots=shots), COVERED, elsewhere)


@pytest.mark.parametrize(("size", "codes"), [(None, ["V030"]), (0.9, ["V030"]), (1.4, []), (2.2, [])])
def test_a_target_that_is_to_be_larger_than_the_frame_is_cropped_on_purpose(
    size: float | None, codes: list[str]
) -> None:
    assert told(with_shot(size=size), CROPPED) == codes


def test_the_size_of_a_subject_counts_before_that_of_its_shot() -> None:
    small, large = (Subject(name, PLACES, size, None, ()) for name, size in (("mast", 0.4), ("tower", 2.2)))
    assert told(with_shot(size=0.4, subjects=(small, large)), CROPPED) == []
    assert told(with_shot(size=2.2, subjects=(small,)), CROPPED) == []


@pytest.mark.parametrize("lost", [COVERED, HIDDEN])
def test_what_a_shot_allows_is_not_told(lost: Claim) -> None:
    assert told(with_shot(allow=("hidden-subject",)), lost) == []
    assert told(with_shot(allow=("hidden-subject",)), CROPPED) == ["V030"]
