"""Helps of codes that `plan` finds, each done with one choice of the author; see ``by_hand``."""

from __future__ import annotations

from tests.support.remedies.by_hand import hand

WAYS = "keyframes: [{at: [0, -24, 6], look_at: mast}, {at: [-30, 0, 6], look_at: mast}]"

PLANNED_HANDS = [
    hand("N016", "name the `target` of the keyframe", ("box: [-0.1, -0.6, 0.1, 0.4]", "target: tower")),
    hand("K014", "add a drone", ("drones:\n", "drones:\n  cam2: {model: x500, home: [20, -60, 0]}\n")),
    hand(
        "M008",
        "move the shot or zone `tree` by # m",
        ("center: [30, 8]", lambda m: f"center: [30, {8 + m:.2f}]"),
    ),
    hand(
        "M011",
        "put `home` where target `runner` is not between it and the shots",
        ("home: [-12, 0, 0]", "home: [60, 0, 0]"),
    ),
    hand(
        "M015",
        "raise its `limits`",
        (
            "home: [0, -30, 0]",
            "home: [0, -30, 0], limits: {speed: 30 m/s, acceleration: 30 m/s^2, jerk: 200 m/s^3}",
        ),
    ),
    hand(
        "M015",
        "move them nearer to the way of the target",
        ("[-18, 0, 3]", "[-9.5, 0, 3]"),
        ("[-9, 0, 5]", "[-9, 0, 3.2]"),
    ),
    hand(
        "M013",
        "put `home` where the axis of `runner` comes no nearer than # m",
        ("home: [45, 0, 0]", lambda m: f"home: [45, {-m:.2f}, 0]"),
    ),
    hand(
        "M038",
        "give the shots more room",
        ("offset: [1.6, 10,", "offset: [1.6, 14,"),
        ("offset: [2.6, 10,", "offset: [2.6, 14,"),
    ),
    hand("D057", "fewer letters", ("GOODBYE", "GO")),
    hand("D083", "how long it is to stand", ("hold: 0", "hold: 9")),
    hand(
        "D087", "bring their pads and pictures farther apart", ("center: [-38, 0, 40]", "center: [40, 0, 40]")
    ),
    hand(
        "Q006",
        "move the path or zone `pole` by # m if the ideal matters",
        ("[30.6, 40.6]", lambda m: f"[{30.6 + m:.2f}, {40.6 + m:.2f}]"),
    ),
    hand(
        "Q007",
        "add a keyframe farther from the target",
        ("      - {at: [5, 36, 8]", "      - {at: [46, 40, 8], look_at: lamp}\n      - {at: [5, 36, 8]"),
    ),
    hand("Q007", "widen gimbal.pitch", ("30 deg], yaw", "70 deg], yaw")),
    hand(
        "Q009",
        "pass at least # m to one side of it",
        ("at: [25.5, 7.5, 1]", lambda m: f"at: [{25.5 - 0.16 * m:.2f}, {7.5 + m:.2f}, 1]"),
    ),
    hand(
        "Q009",
        "give `heading` and `pitch`",
        ("{at: [46, 10, 8], look_at: lamp}", "{at: [46, 10, 8], heading: 263 deg, pitch: -18 deg}"),
        ("{at: [5, 5, 8], look_at: lamp}", "{at: [5, 5, 8], heading: 263 deg, pitch: -18 deg}"),
        ("target: lamp\n    composition: center\n    keyframes:", "keyframes:"),
    ),
    hand("T003", "shorten what comes before", ("home: [0, -30, 0]", "home: [-18, -22, 0]")),
    hand(
        "T004",
        "shorten the mission by # s, cut it in two",
        ("start: 105 s", lambda s: f"start: {105 - s:.2f} s"),
    ),
    hand(
        "T005",
        "a keyframe elsewhere",
        ("look_at: mast}\n      - {at: [-20, -20, 8]", "look_at: mast}\n      - {at: [-20, -19, 8]"),
    ),
    hand(
        "V019",
        "film from farther away or through a wider lens where the target is cropped",
        ("at: [30, -12, 4]", "at: [30, -60, 8]"),
        ("home: [0, -30, 0]", "home: [0, -60, 0]"),
    ),
    hand("V020", "turn the camera less there", ("{at: [24, -20, 6]", "{at: [-48, -40, 6]")),
    hand(
        "V022",
        "bring them # m farther apart; then plan again",
        ("at: [1, -30, 9]", lambda m: f"at: [{1 + m:.2f}, -30, 9]"),
    ),
    hand("V028", "film from another side or from higher up there", ("at: [0, -24, 6]", "at: [-24, 0, 6]")),
    hand(
        "V034",
        "give the way # m more room",
        ("[-24, 0, 30]", lambda m: f"[{-24 - m / 2:.2f}, 0, 30]"),
        ("[24, 0, 30]", lambda m: f"[{24 + m / 2:.2f}, 0, 30]"),
    ),
    hand(
        "V050",
        "film from another side or from higher up, so that nothing stands on the line of sight",
        ("at: [0, -24, 6]", "at: [-24, 0, 6]"),
    ),
    hand(
        "V035",
        "give the way # m more room; then plan again",
        ("at: [-15, 3, 3]", lambda m: f"at: [-15, {3 + m:.2f}, 3]"),
    ),
    hand(
        "E101",
        "write `origin: {lat: ..., lon: ..., alt: ...}` under `world`",
        ("targets:", "world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}\ntargets:"),
    ),
    hand("E101", "take `mavlink` out of `emit`", ("[mavlink]", "[csv]")),
    hand(
        "E102",
        "plan a path that does not cross its footprint",
        ("at: [-20, -25, 16]", "at: [-20, -32, 16]"),
        ("at: [20, -25, 16]", "at: [20, -32, 16]"),
    ),
    hand("E105", "film the shot with the field of view of the drone", (", hfov: 50 deg", "")),
    hand("E122", "film the shot with the field of view of the drone", (", hfov: 60 deg", "")),
    hand("E116", "ask for `mavlink` in `output.emit`", ("[dji]", "[mavlink]")),
    hand("E121", "film with a model that has waypoints, as `mini-4-pro`", ("mini-3-pro", "mini-4-pro")),
    hand("E123", "take `rally` out", (", safety: {rally: [[30, -40]]}", "")),
    hand(
        "E145",
        "give each drone air of its own by zones or heights",
        ("[0, -35, 16]", "[30, -40, 30]"),
        ("[0, -15, 16]", "[40, -40, 30]"),
        ("home: [10, -40, 0]", "home: [40, -50, 0]"),
    ),
    *(
        hand(code, said, *edits)
        for code in ("V025", "V033")
        for said, edits in (
            (
                "film from where `two` is # m higher in the picture",
                (("at: [0, 30, 9]", lambda m: f"at: [0, 30, {9 + m:.2f}]"),),
            ),
            (
                "film from where `one` is # m higher in the picture",
                (("at: [0, -30, 9]", lambda m: f"at: [0, -30, {9 + m:.2f}]"),),
            ),
        )
    ),
    hand(
        "V021",
        "change the distance or the field of view there",
        ("[24, -20, 6], look_at: mast", "[12, -11.4, 6], look_at: mast"),
        ("[-24, -20, 6], look_at: mast", "[12.7, -10.6, 6], look_at: mast"),
    ),
    hand(
        "V029",
        "begin or end the shot elsewhere",
        (WAYS, "keyframes: [{at: [120, -16, 6], look_at: mast}, {at: [0, -24, 6], look_at: mast}]"),
    ),
    hand("Q001", "move or shrink zone `wall` or zone `yard`", ("[2, 100, 20]", "[2, 60, 20]")),
    hand(
        "Q001",
        "move the end points",
        ("at: [-20, 0, 8], heading", "at: [20, -20, 8], heading"),
        ("home: [-20, -35, 0]", "home: [20, -35, 0]"),
    ),
    hand(
        "D160",
        "place the pictures or the pads where the way between them is free",
        ("center: [80, 0, 30]", "center: [0, 80, 30]"),
    ),
    hand(
        "D161", "place the pictures where the ways are free", ("center: [80, 0, 20]", "center: [0, 80, 20]")
    ),
]
