"""Courses of shots on their own clock, led round meshes."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.solids import Cylinder
from shotc.ir.owners import Owner
from shotc.planning.clock.moving import Moving
from shotc.planning.free_space import FreeSpace, blocked
from shotc.planning.layered import VisibleSubject, led_round
from tests.support.mesh_spaces import CLEARANCE, space_of
from tests.support.scenes import house, turned
from tests.support.surfaces import distances

TIMES = np.linspace(0.0, 20.0, 41)
STRAIGHT = np.column_stack([np.linspace(-20.0, 20.0, 41), np.zeros(41), np.full(41, 5.0)])


def test_a_free_course_is_its_ideal():
    space = space_of(turned(house(6.0, 6.0, 5.0, 7.0), 0.0, (0.0, 20.0)))
    assert led_round(space, (), (TIMES, STRAIGHT)).places is STRAIGHT
    assert led_round(FreeSpace((), (), ()), (), (TIMES, STRAIGHT)).places is STRAIGHT


@pytest.mark.slow
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_course_through_a_house_leads_round_it_and_comes_back(turn):
    made = turned(house(9.0, 8.0, 6.0, 9.0), turn, (0.0, 1.0))
    space = space_of(made)
    course = led_round(space, (), (TIMES, STRAIGHT)).places
    assert not blocked(space, course[:-1], course[1:], 0.0).any()
    dense = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(course)])
    assert distances(made, dense).min() >= CLEARANCE
    off = np.linalg.norm(course - STRAIGHT, axis=1)
    assert off[[0, -1]].max() < 2.0
    assert off.max() < 12.0


@pytest.mark.slow
def test_a_course_inside_of_a_building_all_the_while_leads_beside_it():
    hall = turned(house(60.0, 16.0, 30.0, 35.0), 0.0, (0.0, -6.0))
    course = led_round(space_of(hall), (), (TIMES, STRAIGHT)).places
    assert (course[:, 1] >= 2.0 + CLEARANCE).all()


@pytest.mark.slow
def test_a_course_keeps_clear_of_what_moves_beside_a_house():
    made = turned(house(9.0, 8.0, 6.0, 9.0), 0.0, (0.0, 3.0))
    bus = Moving(
        Owner("target", "bus", ("targets", "bus")),
        Cylinder((0.0, 0.0), 3.0, -3.0, 3.0),
        2.0,
        lambda t: np.column_stack([2.0 * t - 20.0, np.full(len(t), -6.0), np.full(len(t), 3.0)]),
    )
    course = led_round(space_of(made), (bus,), (TIMES, STRAIGHT)).places
    beside = np.hypot(*(course - bus.at(TIMES))[:, :2].T)
    apart = np.hypot(np.maximum(beside - 3.0, 0.0), np.maximum(course[:, 2] - 6.0, 0.0))
    assert apart.min() >= 2.0
    assert apart.min() < 4.0
    assert distances(made, course).min() >= CLEARANCE


@pytest.mark.slow
def test_where_no_course_is_free_the_ideal_is_returned():
    hall = house(400.0, 400.0, 100.0, 120.0)
    assert led_round(space_of(hall), (), (TIMES, STRAIGHT)).places is STRAIGHT


def watched(place, surface, **changes):
    """A person who stands at a place all the while."""
    places = np.tile(np.array(place, dtype=float), (len(TIMES), 1))
    return replace(VisibleSubject(places, np.ones(len(TIMES), dtype=bool), 0.4, 1.8, (surface,)), **changes)


@pytest.mark.slow
def test_a_course_is_led_to_where_its_subject_is_not_hidden():
    made = turned(house(3.0, 3.0, 9.0, 10.0), 0.0, (0.0, 7.0))
    space = space_of(made)
    person = watched((0.0, 14.0, 0.9), space.meshes[0].mesh.surface)
    assert person.hidden(STRAIGHT[:, None]).max() > 0.9
    course = led_round(space, (), (TIMES, STRAIGHT), person)
    before, after = person.hidden(STRAIGHT[:, None]), person.hidden(course.places[:, None])
    assert after.sum() < 0.5 * before.sum()
    off = np.linalg.norm(course.places - STRAIGHT, axis=1)
    assert (off <= 0.4 * np.linalg.norm(person.places - STRAIGHT, axis=1) + 1e-9).all()
    assert course.for_sight[20] == 1.0
    assert course.for_sight[0] == 0.0
    unfilmed = replace(person, filmed=np.zeros(len(TIMES), dtype=bool))
    assert led_round(space, (), (TIMES, STRAIGHT), unfilmed).places is STRAIGHT


def test_what_belongs_to_its_subject_does_not_hide_it():
    tower = turned(house(4.0, 4.0, 20.0, 24.0), 0.0, (0.0, 15.0))
    space = space_of(tower)
    itself = watched((0.0, 15.0, 12.0), space.meshes[0].mesh.surface, radius=3.0, height=24.0)
    assert itself.hidden(STRAIGHT[:, None]).max() == 0.0


@pytest.mark.slow
def test_a_course_that_is_held_stays_where_it_is_free():
    made = turned(house(3.0, 3.0, 9.0, 10.0), 0.0, (0.0, 7.0))
    space = space_of(made)
    person = watched((0.0, 14.0, 0.9), space.meshes[0].mesh.surface)
    held = np.zeros(len(TIMES), dtype=bool)
    held[[0, 20, -1]] = True
    course = led_round(space, (), (TIMES, STRAIGHT), person, held)
    off = np.linalg.norm(course.places - STRAIGHT, axis=1)
    assert off[held].max() == 0.0
    assert off.max() > 1.0
