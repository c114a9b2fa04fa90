"""Groups of a fleet: which drones they have, what they are called, and what is wrong with them."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.ir.show import drone_names, spans, whole_fleets
from shotc.spec.fleets import NumbersType
from tests.support.show_texts import FLEET, SPHERE, faults, marked, only, resolve, show

GROUPED = FLEET.replace("separation: 2", "separation: 2, groups: {fire: 1-8, ring: [9-20, 60]}")


def of_group(name: str, at: str = "0, 80, 40") -> str:
    frames = f"[{SPHERE.replace('0, 0, 40', at)}]"
    return f"  - {{id: b-{name}, kind: display, fleet: swarm, group: {name}, frames: {frames}}}\n"


ALL = of_group("fire") + of_group("ring", "80, 0, 40")


def test_groups_share_all_but_their_drones_which_keep_names_and_pads_of_the_fleet() -> None:
    mission, plain = resolve(show(fleet=GROUPED, more=ALL)), resolve(show())
    whole = plain.fleets[0]
    rest, fire, ring = mission.fleets
    assert [f.name for f in mission.fleets] == ["swarm", "swarm/fire", "swarm/ring"]
    assert [d.fleet for d in mission.displays] == ["swarm", "swarm/fire", "swarm/ring"]
    assert (len(rest.pads), len(fire.pads), len(ring.pads)) == (39, 8, 13)
    named = dict(zip(drone_names(whole), whole.pads, strict=True))
    for part in mission.fleets:
        assert {name: named[name] for name in drone_names(part)} == dict(
            zip(drone_names(part), part.pads, strict=True)
        )
        assert part._replace(name="swarm", pads=whole.pads, group=None) == whole
    assert drone_names(ring)[-2:] == ("swarm-20", "swarm-60")
    assert (fire.words, rest.words, fire.key) == (
        "group `swarm/fire`",
        "fleet `swarm`",
        ("fleets", "swarm", "groups", "fire"),
    )


def test_groups_put_together_again_are_the_fleet() -> None:
    mission = resolve(show(fleet=GROUPED, more=ALL))
    assert whole_fleets(mission.fleets) == resolve(show()).fleets
    (part,) = whole_fleets(mission.fleets[1:])
    assert spans(part.numbers) == "1-20, 60"
    assert drone_names(part) == tuple(f"swarm-{n:02d}" for n in (*range(1, 21), 60))


@given(st.sets(st.integers(1, 500), min_size=1))
@settings(max_examples=30, deadline=None)
def test_numbers_read_as_they_are_written(numbers: set[int]) -> None:
    written = [int(part) if part.isdigit() else part for part in spans(sorted(numbers)).split(", ")]
    assert NumbersType().read(written) == tuple(sorted(numbers))


def test_an_unknown_group_is_told_with_the_nearest_name() -> None:
    text = show(fleet=GROUPED, more=ALL.replace("group: fire", "group: fires"))
    d = only(text)
    assert (d.code, marked(d, text), d.help) == ("N020", "fires", "did you mean `fire`?")
    bare = show(display="    group: fire\n")
    assert (only(bare).code, only(bare).help) == (
        "N020",
        "give it drones, as `groups: {fire: 1-20}` of the fleet",
    )


@pytest.mark.parametrize(
    ("ring", "code", "message"),
    [
        ("[8-20, 60]", "D134", "drone 8 of fleet `swarm` is in groups `fire` and `ring`"),
        ("[9-20, 61]", "D135", "fleet `swarm` has 60 drones, and no drone 61"),
        ("[]", "S008", "a group needs a drone"),
        ("20-9", "S014", "`20-9` is no range of drones"),
        ("[9, 9-20]", "S014", "drone 9 is named twice"),
        ("[0]", "S014", "`0` is no range of drones"),
        ("[1000000]", "S014", "a number so large is no range of drones"),
        ("[9.5]", "S007", "expected numbers of drones, got a number"),
        ("all", "S007", "expected numbers of drones, got the text `all`"),
    ],
)
def test_numbers_that_make_no_group(ring: str, code: str, message: str) -> None:
    text = show(fleet=GROUPED.replace("[9-20, 60]", ring), more=ALL)
    d = only(text)
    assert (d.code, d.message, marked(d, text)) == (code, message, ring)


def test_a_group_that_no_display_names_is_told_and_so_are_drones_in_no_group() -> None:
    d = only(show(fleet=GROUPED, more=of_group("fire")))
    assert (d.code, d.message) == ("D023", "group `swarm/ring` shows nothing")
    d = only(show(fleet=GROUPED, display="    group: fire\n", more=of_group("ring")))
    assert (d.code, d.message) == (
        "D023",
        "39 of 60 drones of fleet `swarm` are in no group, and show nothing",
    )


def test_a_display_of_nobody_is_told() -> None:
    text = show(fleet=GROUPED.replace("[9-20, 60]", "9-60"), more=ALL)
    d = only(text)
    assert (d.code, marked(d, text), marked(d, text, 1)) == ("D136", "swarm", "groups")
    assert d.help.startswith("write `group: fire` or `group: ring`; for a picture by all,")


def test_a_pyro_cue_names_drones_by_their_numbers_in_the_fleet() -> None:
    cue = "    pyro: [{at: 30 s, drones: [%s], product: comet, duration: 1 s, clear: 2 m}]\n"
    display = "    group: ring\n" + cue
    more = of_group("fire") + of_group("ring").replace("b-ring", "c").replace("0, 80, 40", "0, -80, 40")
    more += ALL.splitlines(keepends=True)[0].replace("group: fire, ", "").replace("b-fire", "d")
    assert not faults(show(fleet=GROUPED, display=display % "9, 60", more=more))
    text = show(fleet=GROUPED, display=display % "9, 21", more=more)
    d = only(text)
    assert (d.code, marked(d, text), marked(d, text, 1)) == ("D132", "21", "[9-20, 60]")
    assert d.help == "give their numbers in the fleet: 9-20, 60"


def test_pads_are_judged_as_the_fleet_s() -> None:
    near = GROUPED.replace("spacing: 4", "spacing: 1.5")
    assert [d.code for d in faults(show(fleet=near, more=ALL))] == ["D137"]


def test_too_many_drones_for_a_picture_are_those_of_the_group() -> None:
    tiny = ALL.replace("center: [0, 80, 40], radius: 15", "center: [0, 80, 40], radius: 0.05")
    fleet = GROUPED.replace("fire: 1-8", "fire: [1-8, 21-59]")
    text = show(fleet=fleet, display="    group: ring\n", more=tiny)
    d = next(d for d in faults(text) if d.code == "D018")
    assert marked(d, text, 1) == "[1-8, 21-59]"
    assert "group `swarm/fire` has 47" in d.notes[1]
