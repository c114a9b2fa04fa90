"""Boxes and groups of targets: what they are resolved to, and what is wrong with them, told on its line."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, radians, sin

import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.geom.shapes import BoxShape, GroupShape
from shotc.geom.solids import Cylinder, Prism
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.planfile.sanity import mission_faults
from tests.support.front_passes import placed
from tests.support.records import replace

MISSION = """\
shotc: 1
mission: boxes
targets:
  TARGET
  mast: {at: [40, 0, 6], radius: 1, height: 12}
drones: {cam1: {model: x500, home: [0, -60, 0]}}
shots:
  - {id: look, kind: static, drone: cam1, at: [0, -40, 15], look_at: mast}
"""
BEND = "{points: [[0, 0, 1], [40, 0, 1], [40, 40, 1]], speed: 4 m/s}"


def resolved(target: str) -> MissionIR:
    ir, found = placed(MISSION.replace("TARGET", target).encode())
    assert ir is not None, found
    return ir.mission


def told(target: str) -> list[Diagnostic]:
    return list(check_source(MISSION.replace("TARGET", target).encode(), "m.yaml", None).diagnostics)


def test_a_box_lies_by_its_heading_and_stands_where_it_has_no_height() -> None:
    house = resolved("house: {at: [5, 6], size: [10, 4, 3], heading: 30 deg}").target("house")
    assert house.shape == BoxShape(10.0, 4.0, 3.0, (sin(radians(30)), cos(radians(30))))
    assert house.centre == (5.0, 6.0, 1.5)
    assert resolved("house: {at: [5, 6, 2], size: [10, 4, 3]}").target("house").shape.ahead == (0.0, 1.0)


def test_a_box_that_moves_faces_the_way_it_goes() -> None:
    car = resolved(f"car: {{track: {BEND}, size: [4.5, 1.8, 1.5]}}").target("car")
    for t, yaw in ((0.0, 0.0), (5.0, 0.0), (10.0, pi / 4), (15.0, pi / 2), (60.0, pi / 2)):
        shape = car.shape_at(t)
        assert isinstance(shape, BoxShape)
        assert shape.ahead == pytest.approx((cos(yaw), sin(yaw)), abs=1e-9)
    assert isinstance(car.solid_at(15.0), Prism)


def test_clearance_of_a_box_that_turns_counts_from_the_cylinder_about_it() -> None:
    car = resolved(f"car: {{track: {BEND}, size: [4.5, 1.8, 1.5]}}").target("car")
    body = car.kept_clear_at(15.0)
    assert isinstance(body, Cylinder)
    assert body.radius == pytest.approx(2.4233, abs=1e-4)
    assert (body.bottom, body.top) == pytest.approx((0.25, 1.75))
    house = resolved("house: {at: [5, 6], size: [10, 4, 3]}").target("house")
    assert house.kept_clear == house.solid


def test_a_group_is_about_the_middle_of_its_parts_and_no_body() -> None:
    mission = resolved(
        "nave: {at: [49, 0, 4], size: [10, 16, 8], heading: 90 deg}\n  church: {parts: [mast, nave]}"
    )
    church = mission.target("church")
    # Its length lies East: the nave reaches from x = 44 to 54, the mast from 39.
    assert church.centre == pytest.approx((46.5, 0.0, 6.0))
    assert isinstance(church.shape, GroupShape)
    assert [part.offset for part in church.shape.parts] == [(-6.5, 0.0, 0.0), (2.5, 0.0, -2.0)]
    assert church.foot[2] == pytest.approx(0.0)
    assert [t.name for t in mission.targets] == ["nave", "mast"]
    assert mission.one_with("mast") == {"mast", "nave"} == mission.one_with("church")


@pytest.mark.parametrize(
    ("target", "code", "line", "message"),
    [
        ("car: {at: [0, 0, 1], size: [4, 2, 1], radius: 1}", "S005", 4, "`radius` cannot stand"),
        ("car: {at: [0, 0, 1], size: [4, 0, 1]}", "S014", 4, ""),
        ("car: {at: [0, 0, 1], size: [4, -2, 1]}", "S014", 4, ""),
        ("car: {at: [0, 0, 1], size: [4, .nan, 1]}", "U006", 4, ""),
        ("car: {at: [0, 0, 1], size: [4e9, 2, 1]}", "U006", 4, ""),
        ("car: {at: [0, 0, 1], size: [4, 2]}", "S008", 4, ""),
        ("car: {at: [0, 0, 1], heading: 3 deg}", "S004", 4, ""),
        ("car: {at: [0, 0, 1], radius: 1, height: 2, heading: 3 deg}", "S005", 4, "cannot stand"),
        ("car: {at: [0, 0, 1]}", "S004", 4, "missing `radius` with `height`"),
        (f"car: {{track: {BEND}, size: [4, 2, 1], heading: 3 deg}}", "S005", 4, "cannot stand"),
        (f"car: {{track: {BEND}, size: [2, 4, 1]}}", "G040", 4, "target `car` goes sideways"),
        ("car: {parts: [mast]}", "S008", 4, ""),
        ("car: {parts: [mast, tower]}", "N001", 4, "unknown target `tower`"),
        ("car: {parts: [mast, car]}", "G041", 4, "`car` cannot be a part"),
        ("car: {parts: [mast, mast]}", "G041", 4, "`mast` cannot be"),
        ("car: {parts: [mast, mast], radius: 3, height: 2}", "S005", 4, ""),
        (f"man: {{track: {BEND}, radius: 1, height: 2}}\n  car: {{parts: [mast, man]}}", "G041", 5, "`man`"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_on_its_line(target: str, code: str, line: int, message: str) -> None:
    found = told(target)
    assert [d.code for d in found] == [code]
    assert found[0].labels[0].span.line == line
    assert message in found[0].message
    assert found[0].help or code == "S004"


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (lambda m: replace(m, targets=tuple(map(wider, m.targets))), "mission.targets[0].shape"),
        (lambda m: replace(m, targets=tuple(map(longer, m.targets))), "mission.targets[0].shape"),
        (lambda m: replace(m, targets=m.targets[1:]), "mission.groups[0]"),
        (lambda m: replace(m, groups=tuple(map(moved, m.groups))), "mission.groups[0].shape"),
    ],
)
def test_a_shape_in_a_plan_that_is_none_is_refused(
    change: Callable[[MissionIR], MissionIR], path: str
) -> None:
    mission = resolved("nave: {at: [49, 0, 4], size: [10, 16, 8]}\n  church: {parts: [nave, mast]}")
    assert not list(mission_faults(mission))
    assert path in [where for where, _ in mission_faults(change(mission))]


def wider(target: Target) -> Target:
    """A box of less than no width."""
    return target._replace(shape=target.shape._replace(width=-1.0)) if target.name == "nave" else target


def longer(target: Target) -> Target:
    """A course that is no unit vector."""
    return target._replace(shape=target.shape._replace(ahead=(2.0, 0.0))) if target.name == "nave" else target


def moved(group: Target) -> Target:
    return group._replace(centre=(0.0, 0.0, 0.0))
