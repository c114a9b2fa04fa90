"""What the help proposes for the slips that people make who film rather than program."""

import pytest

from shotc.spec.words import closest

MISSION = """\
shotc: 1
mission: look
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
targets:
  tower: {at: {lat: 47.3769, lon: 8.5417, height: 12}, radius: 4, height: 24}
drones:
  cam1: {home: [0, -60, 0], camera: {hfov: 70 deg, aspect: 1.6}}
shots:
  - id: walk
    kind: keyframes
    drone: cam1
    target: tower
    timing: {duration: 30}
    require: {in_frame: 100 %}
    keyframes:
      - {at: [-40, -40, 10], look_at: tower, frame: left-third}
      - {at: [40, -40, 10], look_at: tower}
  - {id: round, kind: orbit, drone: cam1, target: tower, radius: 50, altitude: 20, sweep: 180 deg}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "message", "help_"),
    [
        ("height: 12}", "alt: 420}", "unknown key `alt`", "did you mean `height`?"),
        ("id: walk", "name: walk", "unknown key `name`", "did you mean `id`?"),
        ("at: [-40, -40, 10]", "position: [-40, -40, 10]", "unknown key `position`", "did you mean `at`?"),
        ("radius: 50", "radius: 50, hfov: 40 deg", "unknown key `hfov`", "the `camera`'s of a drone"),
        ("radius: 50", "radius: 50, speed: 3", "unknown key `speed`", "`timing: {duration: ...}`"),
        ("frame: left-third", "frame: left", "unknown frame `left`", "did you mean `left-third`?"),
        ("timing: {duration: 30}", "timing: 30", "expected a timing, got a number", "`{duration: 30}`"),
        ("timing: {duration: 30}", "timing: 30 s", "got the text `30 s`", "`{duration: 30 s}`"),
        ("timing: {duration: 30}", "timing: soon", "got the text `soon`", "write `auto`, or a mapping"),
        ("in_frame: 100 %", "in_frame: 120 %", "above what a share may be", "give 0 % to 100 %"),
        ("frame: left-third", "frame: [640, 360]", "above what a place on screen may be", "give -1 to 1"),
        ("hfov: 70 deg, aspect: 1.6", "hfov: 70 deg, aspect: 16/9", "aspect `16/9`", 'such as "16:9"'),
        ("sweep: 180 deg", "sweep: south", "got the text `south`", "write `180 deg`"),
        ("sweep: 180 deg", "sweep: NE", "got the text `NE`", "write `45 deg`"),
        (
            "      - {at: [40, -40, 10], look_at: tower}\n",
            "",
            "`keyframes` has 1, and 2 or more are needed",
            "camera poses in order",
        ),
    ],
)
def test_the_help_names_what_was_meant(right, wrong, message, help_, loads):
    assert right in MISSION
    assert loads(MISSION).diagnostics == ()
    found = loads(MISSION.replace(right, wrong, 1)).diagnostics[0]
    assert message in found.message
    assert help_ in found.help


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("towr", ["tower", "tree"], "tower"),
        ("TOWER", ["tower", "tree"], "tower"),
        ("max_speed", ["radius", "speed"], "speed"),
        ("xy", ["proxy"], None),
        ("mavic", ["x500", "mini"], None),
    ],
)
def test_the_closest_word(word, known, meant):
    assert closest(word, known) == meant
