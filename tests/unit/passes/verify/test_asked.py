"""What is told of a plan whose data are not what its mission asks for."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.passes.verify.asked import SAME_SHARE, differences
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

ASKED = orbit_plan().trajectory.keyframes
MISSION = ASKED.mission
Edit = Callable[[MissionIR], MissionIR]


def told(edit: Edit) -> list[str]:
    return [d.text for d in differences(replace(ASKED, mission=edit(MISSION)), ASKED)]


def test_a_plan_of_its_own_mission_differs_in_nothing() -> None:
    assert list(differences(ASKED, ASKED)) == []
    same = replace(ASKED, mission=replace(MISSION, zones=tuple(replace(z) for z in MISSION.zones)))
    assert list(differences(same, ASKED)) == []


@pytest.mark.parametrize(
    ("edit", "texts"),
    [
        (lambda m: replace(m, wind=3.0), ["wind is 3 in the plan, but 0 in the mission"]),
        (lambda m: replace(m, wind=0.5 * SAME_SHARE), []),
        (lambda m: replace(m, wind=True), ["wind is true in the plan, but 0 in the mission"]),
        (lambda m: replace(m, wind=None), ["wind is nothing in the plan, but 0 in the mission"]),
        (
            lambda m: replace(m, name="other"),
            ["name is `other` in the plan, but `half-orbit` in the mission"],
        ),
        (lambda m: replace(m, zones=m.zones[:1]), ["zones: `field` is left out"]),
        (lambda m: replace(m, zones=m.zones[::-1]), ["zones are in another order, or there twice"]),
        (lambda m: replace(m, zones=(*m.zones, m.zones[0])), ["zones are in another order, or there twice"]),
        (
            lambda m: replace(m, zones=(*m.zones, replace(m.zones[0], name="moat"))),
            ["zones: the mission has no `moat`"],
        ),
        (
            lambda m: replace(m, zones=(replace(m.zones[0], keep="in"), m.zones[1])),
            ["zone `tree`, keep is `in` in the plan, but `out` in the mission"],
        ),
        (
            lambda m: replace(m, emit=("csv",)),
            ["emit is (`csv`) in the plan, but (`csv`, `mavlink`, `rerun`) in the mission"],
        ),
        (
            lambda m: replace(m, emit=("csv", "mavlink", "kml")),
            ["emit is (`csv`, `mavlink`, `kml`) in the plan, but (`csv`, `mavlink`, `rerun`) in the mission"],
        ),
        (
            lambda m: replace(m, rules=None),
            ["rules is nothing in the plan, but a Rules in the mission"],
        ),
    ],
)
def test_what_differs_is_told_with_both_values_and_by_name(edit: Edit, texts: list[str]) -> None:
    assert told(edit) == texts


def test_items_without_a_name_are_told_by_their_number() -> None:
    (placed,) = ASKED.shots
    first, second, *rest = placed.keyframes

    def found(*keyframes: object) -> list[str]:
        written: KeyframeIR = replace(ASKED, shots=(replace(placed, keyframes=keyframes),))
        return [d.text for d in differences(written, ASKED)]

    assert found(first, second, *rest[:-1]) == [
        "placed shot `half`, keyframes: the plan has 4, the mission asks for 5"
    ]
    assert found(first, replace(second, hold=2.0), *rest) == [
        "placed shot `half`, keyframe 2, hold is 2 in the plan, but 0 in the mission"
    ]
