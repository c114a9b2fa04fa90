"""Identification in small: what is drawn by hand is found, and the paper's rule finds less."""

from __future__ import annotations

import pytest

from tests.experiments.papers.identification import filmed, hand_drawn, right, run, towns, within
from tests.experiments.papers.identified_films import films

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made():
    return towns(4)


def test_what_is_drawn_by_hand_is_found(made):
    found = run(made, hand_drawn).trials
    assert len(found) == 24
    assert right(found) >= 0.95
    assert within(found, 1, 0.15) >= 0.9
    assert within(found, 2, 0.05) >= 0.9


@pytest.mark.long
def test_the_rule_as_printed_finds_less_in_one_open_surface(made):
    ours = run(made, hand_drawn, surface=True).trials
    assert right(ours) >= 0.95
    assert within(ours, 1, 0.15) >= 0.8
    assert right(run(made, hand_drawn, paper=True, surface=True).trials) < 0.8


def test_a_building_that_was_drawn_by_hand_is_whole_in_its_film(made):
    takes = filmed(made[:1], run(made[:1], hand_drawn).trials)[:1]
    assert [frames is not None and frames.all() for frames in films(takes)] == [True]
