"""Helps about files to import: each is done literally, and the file makes a mission."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import pytest

from shotc.importers.mission import ImportOptions, imported
from tests.support.front_passes import placed


class Import(NamedTuple):
    """A file that is refused with a code, and the file and the options as the help says."""

    format: str
    code: str
    file: str
    mended: str
    options: ImportOptions = ImportOptions()


def plan(*frames: int) -> str:
    """Return a plan of QGroundControl without a height of its home; frames : of its waypoints."""
    items: list[dict[str, Any]] = [
        {"type": "SimpleItem", "command": 16, "frame": frame, "params": [0, 0, 0, None, 47 + i / 1e4, 8, 420]}
        for i, frame in enumerate(frames)
    ]
    return json.dumps({"mission": {"items": items}})


def tour(*views: str) -> str:
    made = "".join(f"<Placemark>{view}</Placemark>" for view in views)
    return f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{made}</Document></kml>'


def view(lat: float, mode: str = "absolute") -> str:
    place = f"<longitude>8</longitude><latitude>{lat}</latitude><altitude>420</altitude>"
    return f"<Camera>{place}<heading>90</heading><tilt>80</tilt><altitudeMode>{mode}</altitudeMode></Camera>"


TABLE = "latitude,longitude,altitude(m),heading(deg),gimbalmode,gimbalpitchangle\n"
FIRST, SECOND = "47,8,20,90,2,-10\n", "47.0002,8,20,90,2,-10\n"
GROUND = ImportOptions(ground=400.0)
CASES = [
    Import("litchi", "I002", f"a,b\n{FIRST}{SECOND}", TABLE + FIRST + SECOND),
    Import("litchi", "I003", TABLE + FIRST, TABLE + FIRST + SECOND),
    Import("kml", "I003", tour(""), tour(view(47), view(47.0002))),
    Import("kml", "I003", tour(view(47)), tour(view(47), view(47.0002))),
    Import("kml", "I007", *[tour(view(47), view(47.0002, "relativeToGround"))] * 2, GROUND),
    Import("qgc", "I007", *[plan(0, 3)] * 2, GROUND),
]


@pytest.mark.parametrize("case", CASES, ids=[f"{case.format}-{case.code}" for case in CASES])
def test_what_a_help_about_an_import_says_makes_a_mission(case: Import) -> None:
    refused = imported(case.format, case.file.encode(), "file", strict=False)
    assert refused.text is None
    (fault,) = (d for d in refused.diagnostics if d.code == case.code)
    assert fault.help
    made = imported(case.format, case.mended.encode(), "file", strict=False, options=case.options)
    assert made.text is not None
    assert placed(made.text)[0] is not None
