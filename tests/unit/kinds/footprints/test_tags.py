"""Heights of buildings as people write them into OpenStreetMap."""

from __future__ import annotations

import pytest

from shotc.kinds.footprints.tags import extent_of, is_building, is_part, name_of


@pytest.mark.parametrize(
    ("tags", "bottom", "top"),
    [
        ({"height": 12}, 0, 12),
        ({"height": "12"}, 0, 12),
        ({"height": "12 m"}, 0, 12),
        ({"height": "12.5m"}, 0, 12.5),
        ({"height": "12,5 m"}, 0, 12.5),
        ({"height": "40'"}, 0, 12.192),
        ({"height": "40'6\""}, 0, 12.3444),
        ({"height": "40 ft"}, 0, 12.192),
        ({"building:levels": "2"}, 0, 6),
        ({"building:levels": 2, "roof:levels": 1}, 0, 9),
        ({"building:levels": 2, "roof:levels": 1, "roof:height": "2.5"}, 0, 8.5),
        ({"height": 20, "building:levels": 2}, 0, 20),
        ({"height": 20, "min_height": "8 m"}, 8, 20),
        ({"height": 20, "building:min_level": 3}, 9, 20),
        ({"height": -1, "building:levels": 2}, 0, 6),
        ({"height": -1}, 0, None),
        ({"height": 0}, 0, None),
        ({"height": True}, 0, None),
        ({"height": 1e9}, 0, None),
        ({"height": float("nan")}, 0, None),
        ({"height": None}, 0, None),
        ({}, 0, None),
    ],
)
def test_heights(tags, bottom, top):
    extent = extent_of(tags)
    assert extent.bottom == pytest.approx(bottom)
    assert extent.top == (None if top is None else pytest.approx(top))


def test_a_text_that_is_no_height_is_named():
    assert extent_of({"height": "about 12"}) == (0.0, None, "height: about 12")
    assert not extent_of({"height": "12"}).unread


def test_buildings_and_their_parts():
    assert is_building({"building": "yes"})
    assert is_building({"building:part": "tower"})
    assert not is_building({"building": "no"})
    assert not is_building({"landuse": "forest"})
    assert is_part({"building:part": "yes"})
    assert not is_part({"building": "church"})


def test_names_can_be_shown():
    assert name_of("St. Mary\x1b[31m\n") == "St. Mary [31m"
    assert name_of(12) == "12"
    assert name_of(["a"]) == name_of(None) == name_of(True) == ""
    assert len(name_of("x" * 1000)) == 80
