"""D095 and up: effects of lights. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import slip
from shotc.diag.model import Severity

_PASSING = """\
shotc: 1
mission: show
fleets:
  swarm: {count: 60, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 1, rise: 10}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    viewpoint: [0, -100, 2]
    frames:
      - sphere: {center: [30, 30, 40], radius: 12}
        hold: 6
        effects:
          - ramp: {colors: [red, gold, blue], at: [0, 0.3, 1], along: up}
          - {chase: {color: white, along: right, period: 2 s, length: 0.25}, blend: add}
      - {cube: {center: [30, 30, 40], size: 20}, hold: 6, color: blue}
    effects:
      - {sparkle: {share: 0.2}, from: {frame: 1}, until: {frame: 2}}
"""


def _file(number: int, slug: str, severity: Severity, summary: str, explanation: str) -> CodeInfo:
    return CodeInfo(f"D{number:03d}", slug, severity, summary, explanation, "", "", "other")


CODES: tuple[CodeInfo, ...] = (
    slip(
        "D095",
        "ramp-stops",
        "a ramp has another number of places than colours, or its places do not rise",
        "`at` says where each colour of a ramp is, from 0 where it begins to 1 where it ends: one place a colour, each "
        "at or after the one before. Without `at` the colours are spread evenly.",
        _PASSING,
        ("at: [0, 0.3, 1]", "at: [0.3, 0, 1]"),
    ),
    slip(
        "D096",
        "hasty-chase",
        "the band of a chase passes a light too quickly to be seen",
        "Lights change 25 times a second. A band that is on a light for less than two of these moments, 80 ms, falls "
        "between them on some lights and shows on others. Its length, as a share of the picture, times its period is "
        "how long that is. Make either longer.",
        _PASSING,
        ("period: 2 s, length: 0.25", "period: 0.5 s, length: 0.05"),
    ),
    slip(
        "D097",
        "no-such-frame",
        "an effect begins or ends with a frame that the display does not have",
        "Effects of a display may begin and end with its frames, which are counted from 1. Give one that it has, or "
        "seconds after its first picture stands.",
        _PASSING,
        ("until: {frame: 2}", "until: {frame: 3}"),
    ),
    slip(
        "D098",
        "effect-ends-first",
        "an effect ends before it begins",
        "`from` is when an effect of a display begins, `until` when it ends. Swap them, or leave one out: without "
        "`from` it begins with the display, without `until` it ends with it.",
        _PASSING,
        ("from: {frame: 1}, until: {frame: 2}", "from: {frame: 2}, until: {frame: 1}"),
    ),
    _file(
        99,
        "unseen-effect",
        Severity.WARNING,
        "an effect lasts no time",
        "It counts while a picture stands that is held for no time, or begins after its display is over. What is left "
        "of the show is as it would be without it. Give it the time, or remove it.",
    ),
    _file(
        100,
        "bad-image",
        Severity.ERROR,
        "an image cannot be read",
        "The file is neither a PNG nor a GIF, is cut short or damaged. The note says where. Copy it anew, or export it "
        "again.",
    ),
    _file(
        101,
        "large-image",
        Severity.ERROR,
        "an image is larger than the largest that is read",
        "An image of an effect has at most 25 million pixels, and all frames of a GIF together at most 1500 frames and "
        "400 million pixels. That is judged by its header, before anything is decoded. A fleet shows about as many "
        "pixels as it has drones: scale the image down.",
    ),
    _file(
        102,
        "flashing-lights",
        Severity.WARNING,
        "the lights of a fleet flash more than three times in a second",
        "Flashes of a large bright field can set off seizures in people with photosensitive epilepsy. WCAG 2.2, 2.3.1, "
        "draws the line at three in any second: pairs of opposing changes of relative luminance by a tenth or more, the "
        "darker below 0.8. The mean of a fleet's lights is judged. Slow the effect down, or lower its `opacity`; "
        "sparkles, of which each light has its own time, are no flashes.",
    ),
)
