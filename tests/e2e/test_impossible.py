"""Missions that cannot be flown: which code, on which line, with which numbers, and whether its help helps.

Every case plans a mission that fails, reads the report as a user would, applies the change that the help
proposes, and plans again.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from shotc.cli import app, console
from tests.support.command import PLAN, Report, Result

pytestmark = pytest.mark.slow

TOWER = """\
shotc: 1
mission: hard
world:
  zones:
    field: {keep: in, polygon: {points: [[-90, -90], [90, -90], [90, 90], [-90, 90]], height: [1, 60]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1:
    model: x500
    home: [0, -60, 0]
    endurance: 10 min
    limits:
      speed: 5 m/s
      acceleration: 3 m/s^2
    gimbal: {pitch: [-90 deg, 30 deg]}
rules: {composition: center}
shots:
  - id: pass
    kind: keyframes
    drone: cam1
    target: tower
    timing: auto
    keyframes:
      - {at: [-40, -40, 10], look_at: tower}
      - {at: [0, -50, 18], look_at: tower, hold: 1 s}
      - {at: [40, -40, 15], look_at: tower}
"""
WALLS = """\
shotc: 1
mission: hard
world:
  zones:
    field: {keep: in, polygon: {points: [[-50, -50], [50, -50], [50, 50], [-50, 50]], height: [1, 30]}}
    west: {keep: out, box: {center: [-25, 0, 20], size: [49, 4, 40]}}
    east: {keep: out, box: {center: [25, 0, 20], size: [49, 4, 40]}}
drones:
  cam1: {model: x500, home: [0, -40, 0], radius: 0.6}
shots:
  - id: through
    kind: keyframes
    drone: cam1
    keyframes:
      - {at: [-20, -20, 10], heading: 0 deg, pitch: 0 deg}
      - {at: [20, 20, 10], heading: 0 deg, pitch: 0 deg}
"""
CHIMNEY = """\
shotc: 1
mission: hard
world:
  zones:
    north: {keep: out, box: {center: [20, 26, 30], size: [16, 4, 60]}}
    south: {keep: out, box: {center: [20, 14, 30], size: [16, 4, 60]}}
    west: {keep: out, box: {center: [14, 20, 30], size: [4, 16, 60]}}
    east: {keep: out, box: {center: [26, 20, 30], size: [4, 16, 60]}}
    lid: {keep: out, box: {center: [20, 20, 30], size: [16, 16, 4]}}
drones:
  cam1: {model: x500, home: [0, -40, 0]}
shots:
  - id: in
    kind: keyframes
    drone: cam1
    keyframes:
      - {at: [-20, -20, 10], heading: 0 deg, pitch: 0 deg}
      - {at: [20, 20, 10], heading: 0 deg, pitch: 0 deg}
"""
Fix = Callable[[str, Report], str]


@dataclass(frozen=True)
class Case:
    """A mission as a change of a base text, the report that is expected, and fixes read from its help.

    line : text of the line it points at; labelled : texts of other lines that it marks
    told : patterns that message and notes hold
    """

    mission: str
    code: str
    line: str
    told: tuple[str, ...]
    fixes: tuple[Fix, ...]
    labelled: tuple[str, ...] = ()


def tower(old: str, new: str) -> str:
    assert old in TOWER
    return TOWER.replace(old, new)


def walls(gap: float) -> str:
    centre = f"{gap / 2 + 24.5:g}"
    return WALLS.replace("[-25,", f"[-{centre},").replace("[25,", f"[{centre},")


def told(pattern: str, report: Report) -> str:
    """Return what the help says in place of the pattern's group."""
    found = re.search(pattern, report.help)
    assert found is not None, f"no {pattern!r} in {report.help!r}"
    return found[1]


def put(old: str, pattern: str, new: str) -> Fix:
    """Return a fix that writes ``new`` for ``old``, with what the help says in place of ``%s``."""

    def fix(text: str, report: Report) -> str:
        assert old in text
        return text.replace(old, new % told(pattern, report))

    return fix


def widened(text: str, report: Report) -> str:
    assert text == walls(1.0)
    return walls(1.0 + float(told(r"widen the gap by (\S+) m", report)))


def slimmer(text: str, report: Report) -> str:
    less = float(told(r"a radius (\S+) m smaller", report))
    return text.replace("radius: 0.6", f"radius: {0.6 - less:.3f}")


NUMBER = r"(\d+\.?\d*)"
TIME = rf"{NUMBER} s"

CASES = {
    "duration too short": Case(
        tower("timing: auto", "timing: {duration: 21 s}"),
        "T001",
        "timing: {duration",
        (rf"given 21 s, but {TIME} is the shortest", "from keyframe 1 to 2 it takes"),
        (
            put("21 s", rf"`duration: {TIME}`", "%s s"),
            put("speed: 5 m/s", r"`limits.speed` to (\S+ m/s)", "speed: %s"),
        ),
        labelled=("speed: 5 m/s",),
    ),
    "duration of a generated shot too short": Case(
        TOWER.partition("  - id: pass")[0]
        + "  - {id: round, kind: orbit, drone: cam1, target: tower, radius: 45, altitude: 12,"
        + " sweep: 120 deg,\n     timing: {duration: 12 s}}\n",
        "T001",
        "timing: {duration",
        (rf"given 12 s, but {TIME} is the shortest", r"from \d+ % to \d+ % of its way it takes"),
        (put("12 s", rf"`duration: {TIME}`", "%s s"),),
        labelled=("speed: 5 m/s",),
    ),
    "keyframe time impossible": Case(
        tower("tower, hold: 1 s", "tower, hold: 1 s, time: 9.5 s"),
        "T002",
        "time: 9.5 s",
        (rf"{TIME} is the earliest", "from keyframe 1 to 2 it takes"),
        (put("9.5 s", rf"`time: {TIME}`", "%s s"),),
        labelled=("speed: 5 m/s",),
    ),
    "start too early": Case(
        tower("timing: auto", "timing: {start: 12 s}"),
        "T003",
        "timing: {start",
        (rf"starts at 12 s, but {TIME} is the earliest", r"takeoff \d"),
        (put("12 s", rf"`start: {TIME}`", "%s s"),),
    ),
    "endurance too short": Case(
        tower("10 min", "45 s"),
        "T004",
        "endurance: 45 s",
        (rf"takes {TIME}, and its endurance is 45 s", "longest first: shot `pass`"),
        (
            lambda text, report: text.replace(
                "45 s", f"{45 + float(told(rf'shorten the mission by {TIME}', report)):.2f} s"
            ),
        ),
    ),
    "corridor closed by zones": Case(
        walls(1.0),
        "Q001",
        "[-20, -20, 10]",
        ("between zone `west` and zone `east` is 1.00 m; the drone needs 1.20 m",),
        (widened, slimmer),
        labelled=("west: {", "east: {", "[20, 20, 10]"),
    ),
    "keyframe enclosed by zones": Case(
        CHIMNEY,
        "Q001",
        "[-20, -20, 10]",
        ("there is no way for `cam1` from keyframe 1 to 2 of shot `in`",),
        (
            lambda text, report: re.sub(rf" +{told('(lid)', report)}: .*\n", "", text),
            lambda text, report: re.sub(rf" +{told('(west)', report)}: .*\n", "", text),
        ),
        labelled=("north: {", "south: {", "west: {", "east: {", "lid: {", "[20, 20, 10]"),
    ),
    "keyframe above the keep-in zone": Case(
        tower("[0, -50, 18]", "[0, -50, 59.8]"),
        "G003",
        "[0, -50, 59.8]",
        (r"0\.20 m from its border", r"body radius of 0\.60 m"),
        (put("[0, -50, 59.8]", r"to \[(.*)\]", "[%s]"),),
        labelled=("field: {keep: in",),
    ),
    "keyframe outside the keep-in zone": Case(
        tower("[0, -50, 18]", "[0, -95, 18]"),
        "G003",
        "[0, -95, 18]",
        (r"5\.00 m outside",),
        (put("[0, -95, 18]", r"to \[(.*)\]", "[%s]"),),
    ),
    "keyframe in a target": Case(
        tower("targets:", "targets:\n  rock: {at: [0.5, -50, 17], radius: 2, height: 34}"),
        "G004",
        "[0, -50, 18]",
        (r"1\.50 m deep", r"target clearance of 1\.00 m and the body radius of 0\.60 m"),
        (put("[0, -50, 18]", r"to \[(.*)\]", "[%s]"),),
        labelled=("rock: {at",),
    ),
    "no gimbal allows the framing": Case(
        tower("at: [0, 0, 12]", "at: [0, 0, 90]"),
        "G013",
        "[-40, -40, 10]",
        (r"needs a pitch of 54\.7 deg; the gimbal reaches -90\.0 to 30\.0 deg",),
        (put("30 deg]", r"pitch to (\S+ deg)", "%s]"),),
    ),
    "target too large for the frame": Case(
        tower("[0, -50, 18]", "[0, -18, 12]"),
        "G010",
        "[0, -18, 12]",
        (r"cropped, seen from 18\.0 m and 70\.0 deg wide",),
        (
            put("[0, -18, 12]", r"move to (\[.+?\])", "%s"),
            put("hold: 1 s", r"`hfov` to (\S+ deg)", "hold: 1 s, hfov: %s"),
        ),
    ),
    "promise of the size not met": Case(
        tower("timing: auto", "require: {size: [0.4, 0.45]}"),
        "V021",
        "require: {size",
        (r"fills 0\.\d+ of the frame's height in shot `\w+`, 0\.45 is promised at most", "worst at t = "),
        (put("size: [0.4, 0.45]", r"promise `(size: \[\S+ \S+\])`", "%s"),),
    ),
    "promise of the screen error not met": Case(
        tower("timing: auto", "require: {screen_error: 0.00001}").replace("hold: 1 s", "frame: left-third"),
        "V020",
        "require: {screen_error",
        (r"is 0\.0\d+ of half a frame off .* 1e-05 is promised at most", "worst at t = "),
        (put("screen_error: 0.00001", r"promise `(screen_error: \S+)`", "%s"),),
    ),
    "promise of the whole target not met": Case(
        tower("radius: 4, height: 24", "radius: 4, height: 30").replace(
            "timing: auto", "composition: keep\n    require: {in_frame: 100 %}"
        ).replace("[0, -50, 18]", "[0, -26, 18]"),
        "V019",
        "require: {in_frame",
        (r"100 % is promised",),
        (put("in_frame: 100 %", r"promise `(in_frame: \S+ %)`", "%s"),),
    ),
}  # fmt: skip


@pytest.fixture
def planned(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable:
    """Return a function that plans a mission text by the command line, writing tables into ``out``."""
    for name in ("NO_COLOR", "FORCE_COLOR", "GITHUB_ACTIONS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)

    def plan(text: str) -> Result:
        Path("hard.yaml").write_text(text)
        code = app.run([*PLAN, "hard.yaml", "-o", "out", "--emit", "csv", "--jobs", "1"])
        console.configure()
        return Result(code, *capsys.readouterr())

    return plan


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_it_is_refused_with_line_and_numbers_and_its_help_helps(
    planned: Callable[[str], Result], name: str
) -> None:
    case = CASES[name]
    result = planned(case.mission)
    assert (result.code, result.out) == (1, "")
    assert not Path("out").exists()
    first = result.errors[0]
    read(case, first)
    assert not re.search(r"infeasible|illegal|Traceback|nan|\binf\b", result.err)
    for fix in case.fixes:
        result = corrected(planned, case, fix(case.mission, first), fix)
        assert result.code == 0, result.err
        assert {path.name for path in Path("out").iterdir()} == {"plan.json", "trajectory.csv", "framing.csv"}


def read(case: Case, report: Report) -> None:
    """Hold a report to the case: code, line, marks and numbers."""
    lines = case.mission.splitlines()
    assert (report.code, report.line) == (case.code, found(lines, case.line))
    for text in (case.line, *case.labelled):
        assert found(lines, text) in report.labelled, f"{text!r} is not marked"
    for pattern in case.told:
        assert re.search(pattern, report.text), f"{pattern!r} not in {report.text!r}"


def found(lines: list[str], text: str) -> int:
    (line,) = [number for number, line in enumerate(lines, 1) if text in line]
    return line


def corrected(planned: Callable[[str], Result], case: Case, mission: str, fix: Fix) -> Result:
    """Plan a corrected mission; where several keyframes had the fault, correct one after the other."""
    result = planned(mission)
    for _ in range(2):
        if result.code == 0 or result.errors[0].code != case.code:
            break
        mission = fix(mission, result.errors[0])
        result = planned(mission)
    return result
