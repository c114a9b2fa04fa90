from __future__ import annotations

from shotc.ir.text import dump
from tests.support.film_plans import orbit_mission, orbit_plan


def test_a_dump_is_stable_text_without_addresses():
    assert dump(orbit_plan()) == dump(orbit_plan())
    assert " at 0x" not in dump(orbit_plan())


def test_a_dump_names_every_level_by_its_type_and_fields():
    lines = [line.strip() for line in dump(orbit_mission()).splitlines()]
    assert lines[:2] == ["MissionIR", "name: half-orbit"]
    tower = lines[lines.index("- Target") :]
    assert tower[1:4] == ["name: tower", "centre: [0, 0, 12]", "shape:"]
    assert tower[4:7] == ["CylinderShape", "radius: 4", "height: 24"]


def test_numbers_have_nine_digits():
    assert "0.333333333" in dump((1 / 3,))
    assert "0.33333333333" not in dump((1 / 3,))


def test_bytes_are_counted_not_shown():
    assert "7 bytes" in dump((("a.ply", b"ply\n\x00\xff\n"),))
    assert "\\x00" not in dump((("a.ply", b"ply\n\x00\xff\n"),))
