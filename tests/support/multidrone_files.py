"""Small missions of the MultiDrone project, written for the tests."""

from __future__ import annotations

import yaml

from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.importers.mission import Imported, import_multidrone

POINT = "<RTTrajectoryPoint><x>{x}</x><y>{y}</y><altitude>-1.0</altitude><time>{t}</time></RTTrajectoryPoint>"
ACTION = """\
<shootingAction shootingActionTemplateRef="{kind}">
  <name>one</name>
  <duration>{duration}</duration>
  <formationSpeed>3.6</formationSpeed>
  <RTTrajectory>{points}</RTTrajectory>
  <originOfFormation><x>12</x><y>-3</y><altitude>-1.0</altitude><time>0</time></originOfFormation>
  <shootingRoles><shootingRole>
    <name>{kind}</name>
    <framingTypeName>FRAMING_TYPE_MS</framingTypeName>
    <shootingTypeName>{composition}</shootingTypeName>
    <params>{params}</params>
  </shootingRole></shootingRoles>
</shootingAction>
"""
MISSION = """\
<?xml version="1.0" encoding="UTF-8"?>
<mission eventRef="GO">
<targetTypes><targetType><name>TARGET_RUNNER</name></targetType></targetTypes>
<shootingActionSequences><shootingActionSequence>
<name>S1</name><role>main</role>
<shootingActions>
{actions}</shootingActions>
</shootingActionSequence></shootingActionSequences>
</mission>
"""
WAY = ((0, 0, 0), (40, 0, 20), (60, 20, 40))


def action(kind: str, params: str, way=WAY, duration: str = "20", composition: str = "RULE_OF_THIRDS") -> str:
    points = "".join(POINT.format(x=x, y=y, t=t) for x, y, t in way)
    return ACTION.format(kind=kind, params=params, points=points, duration=duration, composition=composition)


def imported(*actions: str, strict: bool = False) -> Imported:
    return import_multidrone(MISSION.format(actions="".join(actions)).encode(), "m.xml", strict=strict)


def shots(made: Imported) -> list[dict[str, object]]:
    assert made.text is not None
    assert not has_errors(check_source(made.text.encode(), "m.yaml", None).diagnostics)
    found = yaml.safe_load(made.text)["shots"]
    assert isinstance(found, list)
    return found


def said(made: Imported) -> list[tuple[str, int]]:
    return [(d.message, d.labels[0].span.line) for d in made.diagnostics]


MAP = (
    '<Maps><Map><description>{"KML": "&lt;kml&gt;&lt;LineString&gt;&lt;coordinates&gt;%s'
    '&lt;/coordinates&gt;&lt;/LineString&gt;&lt;/kml&gt;"}</description></Map></Maps>'
)
EARTH = (
    "<RTTrajectoryPoint><latitude>{}</latitude><longitude>{}</longitude><time>{}</time></RTTrajectoryPoint>"
)


def mapped(points: str, coordinates: str) -> str:
    whole = action("LATERAL", '{"y_0": 8, "z_0": 5}')
    start, end = whole.index("<RTTrajectory>"), whole.index("<originOfFormation>")
    return whole[:start] + f"<RTTrajectory>{points}</RTTrajectory>{MAP % coordinates}" + whole[end:]
