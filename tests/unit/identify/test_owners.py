"""Which bodies of a scene are one building: what stands on the ground, and what stands on that."""

from __future__ import annotations

import numpy as np

from shotc.identify.clusters import NOBODY
from shotc.identify.owners import owners_of
from tests.support.cities import mission_of
from tests.support.meshes import box_mesh


def owners(*boxes) -> list[int]:
    """Return the owner of each box, given as centre and size."""
    mission = mission_of(*(box_mesh(*box) for box in boxes))
    (mesh,) = mission.meshes
    found = owners_of(mission, mesh)
    each = [set(found.owner[mesh.part == k].tolist()) for k in range(len(boxes))]
    assert all(len(one) == 1 for one in each)
    return [one.pop() for one in each]


STEM, TANK, SPIRE = ((0, 0, 10), (4, 4, 20)), ((0, 0, 24), (12, 12, 8)), ((1, 0, 31), (1, 1, 6))


def test_what_stands_on_a_building_is_a_part_of_it_however_high() -> None:
    stem, tank, spire = owners(STEM, TANK, SPIRE)
    assert stem == tank == spire != NOBODY
    spire, tank, stem = owners(SPIRE, TANK, STEM)
    assert stem == tank == spire != NOBODY


def test_houses_that_touch_stay_two() -> None:
    one, other = owners(((0, 0, 5), (10, 10, 10)), ((10, 0, 8), (10, 8, 16)))
    assert NOBODY not in (one, other)
    assert one != other


def test_a_roof_is_on_the_house_of_which_it_covers_the_most() -> None:
    one, other, roof = owners(((0, 0, 5), (10, 10, 10)), ((10, 0, 5), (10, 8, 10)), ((9, 0, 11), (12, 9, 2)))
    assert roof == other != one


def test_what_hangs_in_the_air_is_of_nobody() -> None:
    house, balloon, aside = owners(
        ((0, 0, 5), (10, 10, 10)), ((0, 0, 15), (4, 4, 4)), ((30, 0, 11), (4, 4, 2))
    )
    assert house != NOBODY
    assert balloon == aside == NOBODY


def test_owners_know_the_foot_of_what_they_stand_on() -> None:
    mission = mission_of(box_mesh(*STEM), box_mesh(*TANK))
    (mesh,) = mission.meshes
    assert np.all(owners_of(mission, mesh).foot == 0.0)
