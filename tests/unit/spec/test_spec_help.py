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
        ("in_frame: 100 %", "in_frame: 100", "above what a share may be", "write `100 %`"),
        ("in_frame: 100 %", "in_frame: 101", "above what a share may be", "give 0 % to 100 %"),
        ("at: [-40, -40, 10]", "at: [-40, -40]", "expected 3 values [x, y, z], got 2", "write [x, y, z]"),
        ("sweep: 180 deg", "sweep: 2 turns", "unknown unit `turns`", "a turn is 360 deg: write `720 deg`"),
        ("sweep: 180 deg", "sweep: -0.5 rev", "unknown unit `rev`", "write `-180 deg`"),
        ("frame: left-third", "frame: [640, 360]", "above what a place on screen may be", "give -1 to 1"),
        ("hfov: 70 deg, aspect: 1.6", "hfov: 70 deg, aspect: 16/9", "aspect `16/9`", 'such as "16:9"'),
        ("sweep: 180 deg", "sweep: south", "got the text `south`", "write `180 deg`"),
        ("altitude: 20", 'altitude: "20,5 m"', "got the text `20,5 m`", "decimals have a point: `20.5 m`"),
        ("sweep: 180 deg", "sweep: NE", "got the text `NE`", "write `45 deg`"),
        ("timing: {duration: 30}", "timing: {duration: auto}", "text `auto`", "or write `timing: auto`"),
        ("height: 24", "height: [40-65]", "got a list", "such as `12 m`"),
        ("hfov: 70 deg", "sensor: 1 inch, focal_length: 9 mm", "unknown unit `inch`", "sensor's width"),
        ("hfov: 70 deg", "sensor: 1/2.3in, focal_length: 9 mm", "`1/2.3in`", "sensor's width"),
        ("aspect: 1.6", "aspect: 1.6, tilt: 2", "unknown key `tilt`", "known are"),
        ("aspect: 1.6", "aspect: 1.6, zoom: 2", "expected a list [lowest, highest]", ""),
        ("radius: 4", "diameter: 8", "unknown key `diameter`, and `radius` is missing", "write `radius`"),
        ("sweep: 180 deg", "sweep: 180", "an angle needs a unit", "write `180 deg`"),
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
        ("subject", ["target", "id"], "target"),
        ("subject", ["target", "subjects"], "subjects"),
        ("circle", ["sphere", "cube", "torus"], "torus"),
        ("circle", ["orbit", "spiral"], "orbit"),
        ("pedestal", ["crane", "elevator"], "elevator"),
    ],
)
def test_the_closest_word(word, known, meant):
    assert closest(word, known) == meant


@pytest.mark.parametrize(
    ("kind", "help_"),
    [("follow", "did you mean `chase`?"), ("reveal", "`shotc list kinds` says what each does")],
)
def test_an_unknown_kind_of_shot_is_led_to_a_known_one_or_to_the_list(kind, help_, loads):
    (found,) = loads(MISSION.replace("kind: orbit", f"kind: {kind}")).diagnostics
    assert found.code == "S010"
    assert found.help.endswith(help_)


def test_a_value_behind_a_comment_sign_is_quoted_by_the_help(loads):
    text = MISSION.replace("timing: {duration: 30}", "composition: HERE")
    (found,) = (d for d in loads(text.replace("HERE", "#39f")).diagnostics if d.code == "S006")
    assert found.help == '`#` begins a comment; put the value in quotes: "#39f"'
    (other,) = (d for d in loads(text.replace("HERE", "# later")).diagnostics if d.code == "S006")
    assert other.help == "write its value, or remove `composition`"


def spiral(altitude):
    return MISSION.replace("kind: orbit", "kind: spiral").replace("altitude: 20", f"altitude: {altitude}")


@pytest.mark.parametrize("written", ["[40-65]", "40-65", "[40 - 65]", "40 to 65", '["40..65"]'])
def test_a_range_by_hand_is_told_as_two_values(written, loads):
    (found,) = loads(spiral(written)).diagnostics
    assert found.help == "write two values, such as `[40, 65]`"
    assert loads(spiral("[40, 65]")).diagnostics == ()
    assert loads(spiral("[40-65 ft]")).diagnostics[0].help == "write two values, such as `[40 ft, 65 ft]`"


@pytest.mark.parametrize(
    ("right", "wrong", "help_"),
    [
        ("look_at: tower, frame", "lookat: tower, frame", "did you mean `look_at`?"),
        ("look_at: tower, frame", "lok_at: tower, frame", "did you mean `look_at`?"),
        ("look_at: tower, frame", "heading: 0 deg, pich: 0 deg, frame", "did you mean `pitch`?"),
        ("look_at: tower, frame", "gaze: tower, frame", "write `look_at` or `heading` with `pitch` instead"),
        ("radius: 50", "diameter: 100", "write `radius` instead: horizontal distance"),
        ("radius: 50", "radios: 100", "did you mean `radius`?"),
    ],
)
def test_a_required_key_under_another_name_is_one_fault(right, wrong, help_, loads):
    (found,) = loads(MISSION.replace(right, wrong, 1)).diagnostics
    assert found.code == "S003"
    assert found.help.startswith(help_)


@pytest.mark.parametrize(
    "wrong",
    [
        "hfov: 40 deg",  # has its place elsewhere
        "start_azimut: 90 deg",  # an optional key with a slip of the pen
        "swep: 90 deg",  # a key that is there already
        "diameter: 100, colour: red",  # which of them was meant cannot be told
    ],
)
def test_other_pairs_of_unknown_and_missing_keys_stay_apart(wrong, loads):
    found = loads(MISSION.replace("radius: 50", wrong)).diagnostics
    assert sorted({d.code for d in found}) == ["S003", "S004"]


def test_a_shot_may_name_a_point_as_its_composition(loads):
    text = MISSION.replace("kind: orbit", "kind: orbit, composition: upper-left")
    composition = loads(text).mission.spec.shots[1].composition
    assert composition.points == ((-1 / 3, 1 / 3),)


def test_a_point_by_numbers_is_named_by_them(loads):
    text = MISSION.replace("frame: left-third", "frame: [0.9, 0]")
    assert loads(text).mission.spec.shots[0].keyframes[0].frame.name == "[0.9, 0]"


def test_an_aspect_beside_a_sensor_has_to_agree(loads):
    camera = "sensor: [13.2 mm, 8.8 mm], focal_length: 8.8 mm, aspect: {}"
    right, wrong = (MISSION.replace("hfov: 70 deg, aspect: 1.6", camera.format(a)) for a in ("1.51", "1.6"))
    assert loads(right).diagnostics == ()
    (found,) = loads(wrong).diagnostics
    assert found.code == "S005"
    assert len(found.labels) == 2
    assert "sensor: 13.2 mm" in found.help


@pytest.mark.parametrize("head", ['{"format": "shotc-plan"', '\n {\n  "format" :"shotc-plan"'])
def test_a_plan_is_told_from_a_mission_whatever_its_size(head, loads):
    (found,) = loads(head + ', "drones": [' + "0, " * 2_000_000 + "0]}").diagnostics
    assert (found.code, found.message) == ("S017", "this is a plan, not a mission")
