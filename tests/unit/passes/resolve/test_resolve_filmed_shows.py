"""Cameras that film a show, and its pyro, as far as `check` can tell what is wrong."""

from __future__ import annotations

from shotc.diag.model import Diagnostic
from tests.support.front_passes import resolved

SHOW = """\
shotc: 1
mission: filmed
drones:
  cam: {model: x500, home: [0, -70, 0]}
fleets:
  swarm: {count: 12, layout: {grid: {spacing: 4, origin: [20, 20, 0]}}, model: show-drone}
shots:
  - id: dance
    kind: display
    fleet: swarm
    frames: [{sphere: {center: [0, 0, 30], radius: 6}, name: globe, at: 40 s, hold: 12}]
    pyro: [{at: 42 s, drones: [1, 2], product: fountain, duration: 40 s, clear: 2 m}]
  - id: again
    kind: display
    fleet: swarm
    frames: [{cube: {center: [0, 0, 30], size: 12}, at: 70 s, hold: 5}]
    pyro: [{at: 90 s, drones: [2], product: comet, duration: 1 s, clear: 2 m}]
  - {id: l, drone: cam, kind: static, target: globe, at: [0, -45, 30], timing: {duration: 8}, look_at: globe}
"""


def faults(*slips: tuple[str, str]) -> list[Diagnostic]:
    text = SHOW
    for right, wrong in slips:
        assert right in text
        text = text.replace(right, wrong)
    return resolved(text)[1]


def test_a_camera_waits_until_the_display_may_have_ended() -> None:
    assert faults() == []
    (late,) = faults(("{duration: 8}", "{start: 51.9 s, after: dance}"))
    assert (late.code, late.notes) == ("K007", ("`dance` ends at 52.0 s at the earliest",))
    assert faults(("{duration: 8}", "{start: 52 s, after: dance}")) == []


def test_one_drone_burns_one_product_at_a_time_in_all_displays_of_its_fleet() -> None:
    (both,) = faults(("at: 90 s", "at: 81 s"))
    assert (both.code, both.message) == ("D133", "drone 2 fires `comet` while its `fountain` burns")
    (twice,) = faults(("drones: [1, 2]", "drones: [1, 2, 1]"))
    assert (twice.code, twice.message) == ("D133", "drone 1 fires two `fountain` at once")


def test_a_display_that_is_wrong_does_not_make_its_pictures_unknown() -> None:
    assert [d.code for d in faults(("at: 40 s", "at: {bar: 9}"))] == ["D121"]
    assert "N001" in [d.code for d in faults(("at: 40 s", "at: {bar: 9}"), ("target: globe", "target: ball"))]


def test_seconds_before_a_display_are_no_part_of_its_flight() -> None:
    cube = "{cube: {center: [0, 0, 30], size: 12}, "
    shown, later = f"[{cube}at: 70 s, hold: 5}}]", f"[{cube}hold: 1}}, {cube}at: 95 s, hold: 5}}]"
    short = ("model: show-drone", "model: show-drone, endurance: 150 s")
    assert faults((shown, later), short) == []
    long = faults((shown, later.replace("95", "400")), short, ("at: 90 s", "at: 200 s"))
    assert [d.code for d in long] == ["D021"]


def test_a_first_picture_before_its_time_is_led_to_a_moment_that_check_takes() -> None:
    (early,) = faults(("at: 40 s", "at: 1 s"))
    assert early.code == "D020"
    possible = (early.help or "").split("`")[1]
    assert "D020" not in [d.code for d in faults(("at: 40 s", possible))]
