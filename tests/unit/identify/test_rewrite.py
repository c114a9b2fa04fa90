"""Targets put into the text of missions of every layout: the rest of the text stays as it is, to the byte."""

from __future__ import annotations

import difflib

import pytest

from shotc.geom.camera import ScreenBox
from shotc.identify.cylinders import Upright
from shotc.identify.rewrite import Named, NotEditable, rewritten
from shotc.source.yaml_tree import parse

TOWER = {"tower-2": Upright((1.0, -2.004), 4.123, 0.0, 24.5)}
FLOW = """\
shotc: 1
mission: m
# The drones of the film.
drones: {cam: {}}   # one
shots:
  - id: a
    kind: keyframes
    drone: cam
    keyframes:
      - {at: [0, 0, 5], heading: 0 deg, pitch: 0 deg, box: [0, 0, 0.5, 0.5]}  # what is meant
      - {at: [0, 9, 5], heading: 0 deg, pitch: 0 deg}
"""
BLOCK = """\
shotc: 1
mission: m
targets:   # what is filmed
  # an old one
  old: {at: [0, 0], radius: 1, height: 2}

drones:
  cam: {}
shots:
  - id: a
    keyframes:
      - at: [0, 0, 5]   # here
        box: [0, 0,
              0.5, 0.5]   # what is meant
        pitch: 0 deg
      - box:
          - 0
          - 0
          - 1
          - 1
        heading: 3 deg # last
"""
JSON = '{"shotc": 1, "shots": [{"keyframes": [{"at": [0, 0, 5], "box": [0, 0, 1, 1]}]}]}'
KEYFRAME = ("shots", 0, "keyframes", 0)


def added(before: str, after: bytes) -> list[str]:
    """Return the lines that are new, and check that none is gone or changed."""
    lines = list(difflib.ndiff(before.splitlines(), after.decode().splitlines()))
    assert not [line for line in lines if line.startswith("- ")]
    return [line[2:] for line in lines if line.startswith("+ ")]


def made(text: str, *named: Named, **targets: Upright) -> bytes:
    return rewritten(text.encode(), "m.yaml", targets or TOWER, named)


def test_a_section_is_put_before_the_drones_and_their_comment():
    text = made(FLOW, Named(KEYFRAME, "tower-2")).decode()
    assert text.startswith(
        "shotc: 1\nmission: m\ntargets:\n"
        "  tower-2: {at: [1, -2, 12.25], radius: 4.14, height: 24.5}\n# The drones of the film.\n"
    )
    assert "box: [0, 0, 0.5, 0.5], target: tower-2}  # what is meant\n" in text


def test_lines_of_a_block_stay_with_their_comments():
    other = ("shots", 0, "keyframes", 1)
    text = made(BLOCK, Named(KEYFRAME, "tower-2"), Named(other, "old"))
    assert added(BLOCK, text) == [
        "  tower-2: {at: [1, -2, 12.25], radius: 4.14, height: 24.5}",
        "        target: tower-2",
        "        target: old",
    ]
    assert b"# what is meant\n        target: tower-2\n" in text
    assert b"targets:   # what is filmed\n  tower-2:" in text


def test_a_guessed_box_is_written_too():
    guess = Named(("shots", 0, "keyframes", 1), "tower-2", ScreenBox(-0.25, 0.5, -1.0, 1 / 3))
    text = made(FLOW, guess).decode()
    assert "pitch: 0 deg, target: tower-2, box: [-0.250, -1.000, 0.500, 0.333]}\n" in text


def test_json_stays_one_line():
    text = made(JSON, Named(KEYFRAME, "tower-2")).decode()
    assert parse(text.encode(), "m").root["shots"][0]["keyframes"][0]["target"] == "tower-2"
    assert text.startswith("{targets: {tower-2: {")
    assert "\n" not in text


@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_line_ends_and_marks_are_kept(mark):
    text = made(mark + BLOCK.replace("\n", "\r\n"), Named(KEYFRAME, "tower-2"))
    assert text.count(b"\n") == text.count(b"\r\n") == BLOCK.count("\n") + 2
    assert text.startswith(b"\xef\xbb\xbf") == bool(mark)


@pytest.mark.parametrize("targets", ["{}", "{ }", "{old: {at: [0, 0], radius: 1, height: 2}}", "&t {}"])
def test_a_section_in_braces_is_filled(targets):
    text = FLOW.replace("drones:", f"targets: {targets}  # none\ndrones:", 1)
    found = parse(made(text, Named(KEYFRAME, "tower-2")), "m").root["targets"]
    assert next(iter(found)) == "tower-2"


def test_an_anchored_block_is_a_block():
    text = BLOCK.replace("targets:   #", "targets: &all   #").replace("- at:", "- &first\n        at:")
    assert parse(made(text, Named(KEYFRAME, "tower-2")), "m").root["targets"]["tower-2"]["radius"] == 4.14


def test_a_keyframe_that_is_written_elsewhere_is_refused():
    text = FLOW.replace("- {at: [0, 0, 5]", "- &one {at: [0, 0, 5]").replace(
        "- {at: [0, 9, 5], heading: 0 deg, pitch: 0 deg}", "- *one"
    )
    with pytest.raises(NotEditable) as wrong:
        made(text, Named(("shots", 0, "keyframes", 1), "tower-2"))
    assert wrong.value.path == ("shots", 0, "keyframes", 1)
    with pytest.raises(NotEditable):  # the other one would be given it, too
        made(text, Named(KEYFRAME, "tower-2"))
