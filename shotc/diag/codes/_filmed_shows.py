"""D129 and up, V057, V058: shows that cameras film."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.codes._verified import verified
from shotc.diag.model import Severity

_FILMED = """\
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
    frames:
      - {sphere: {center: [0, 0, 30], radius: 6}, name: globe, at: 40 s, hold: 12}
      - {text: {text: HI, center: [0, 0, 30], height: 24}, name: word, size: [40, 2, 24], hold: 4}
  - {id: look, kind: static, drone: cam, target: globe, at: [0, -45, 30], look_at: globe, timing: {duration: 8}}
"""

_BALL = "".join(line for line in _FILMED.splitlines(keepends=True) if "text" not in line)

NAMED: tuple[CodeInfo, ...] = (
    slip(
        "D129",
        "two-targets-of-one-name",
        "a picture of a fleet has the name of another target",
        "`name` of a picture is what shots of cameras call it that film it, so it is the name of one thing: no other picture and "
        "none of the mission's `targets` has it.",
        _FILMED,
        ("name: word", "name: globe"),
    ),
    slip(
        "D130",
        "picture-without-size",
        "the size of a picture that cameras film is not known before planning",
        "A camera frames a body about the picture. That of a ball, a cube or a ring is known; how wide letters, drawings and "
        "models are drawn is not, before the show is planned. `size: [width, depth, height]` says it, and verification proves that "
        "all lights are in it.",
        _FILMED,
        (", size: [40, 2, 24]", ""),
    ),
    slip(
        "D131",
        "display-after-camera",
        "a display waits for a shot of a camera",
        "A show is planned first, and the cameras that film it after it: their shots wait for displays by `after`, or begin when "
        "the picture stands that they film. Displays wait for displays.",
        _FILMED,
        ("    fleet: swarm\n", "    fleet: swarm\n    timing: {after: look}\n"),
    ),
)

_FIRED = _BALL.replace(
    "    frames:\n",
    "    pyro:\n"
    "      - {at: 42 s, drones: [1], product: fountain, duration: 4 s, clear: 2 m}\n"
    "      - {at: 47 s, drones: [1, 2], product: comet, duration: 1 s, clear: 2 m}\n"
    "    frames:\n",
)

FIRED: tuple[CodeInfo, ...] = (
    slip(
        "D132",
        "no-such-drone",
        "a pyro cue is for a drone that the fleet does not have",
        "`drones` of a cue are numbers of the fleet's drones, counted from 1 in the order of their pads.",
        _FIRED,
        ("drones: [1, 2]", "drones: [1, 20]"),
    ),
    slip(
        "D133",
        "two-products-at-once",
        "a drone fires a product while another burns on it",
        "A product is lit `prefire` seconds before it is seen, and burns for its `duration`. A drone carries several, one after "
        "another.",
        _FIRED,
        ("at: 47 s", "at: 45 s"),
    ),
)

STANDING: tuple[CodeInfo, ...] = (
    verified(
        57,
        "lights-outside-picture",
        (
            "lights of a picture are outside the body that cameras frame in its place",
            "What is proved of how a camera frames a named picture is proved of a body about it, which its shape or its `size` "
            "gives, with half the separation on each side. The message says how far lights stand out of it. Write a larger `size`.",
        ),
    ),
    verified(
        58,
        "picture-not-standing",
        (
            "a camera films a picture while it does not stand",
            "The shot begins before the fleet stands in the picture, or goes on after it has left. Its framing is proved of where "
            "the picture is when it stands. Shorten the shot, hold the picture longer, or leave the start of the shot out: it then "
            "begins when the picture stands.",
        ),
        (_BALL.replace("duration: 8", "duration: 20"), _BALL),
        severity=Severity.WARNING,
    ),
    verified(
        59,
        "too-near-to-pyro",
        (
            "somebody is too near to a product that burns, or its drone is not in the air",
            "From ignition to its end, the drone that carries a product is `clear` of all other drones, cameras, the `viewpoint` "
            "of the audience and the ground, at every instant, and it flies. The message says who comes how near, and when.",
        ),
        (_FIRED.replace("duration: 4 s, clear: 2 m", "duration: 4 s, clear: 20 m"), _FIRED),
    ),
)
