"""Bad input, one thing at a time: refused on its line by `check` and by `plan`, and nothing is written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from shotc.cli import app

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: bad
world:
  zones:
    hut: {keep: out, box: {center: [30, 0, 5], size: [8, 8, 10]}}
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1:
    model: x500
    home: [0, -60, 0]
    limits: {speed: 8 m/s}
    camera: {hfov: 70 deg, aspect: "16:9"}
    gimbal: {pitch: [-90 deg, 30 deg]}
shots:
  - id: past
    kind: keyframes
    drone: cam1
    target: tower
    keyframes:
      - {at: [-40, -40, 10], look_at: tower}
      - {at: [0, -50, 18], heading: 0 deg, pitch: 0 deg}
  - {id: track, kind: follow-path, drone: cam1, file: track.csv, heading: along}
"""
TRACK = b"x,y,z\n0,-40,20\n20,-40,20\n"
BOMB = "\n".join(["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]", *(
    f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)
)])  # fmt: skip


@dataclass(frozen=True)
class Bad:
    """What to put in place of what, the code it raises, and the text of the line that it is reported on."""

    old: str
    new: str
    code: str
    line: str | None = None


BAD = {
    "no UTF-8": Bad("past", "p\udcffst", "Y001", "id: p"),
    "NUL": Bad("past", "p\0st", "Y002", "id: p"),
    "tab": Bad("    model", "\tmodel", "Y008", "model"),
    "duplicate key": Bad(
        "    target: tower\n", "    target: tower\n    target: tower\n", "Y012", "    target: tower"
    ),
    "alias bomb": Bad("shotc: 1", f"shotc: 1\n{BOMB}", "Y006"),
    "deep nesting": Bad("shotc: 1", "shotc: " + "[" * 20_000, "Y004", "shotc: "),
    "tag": Bad("mission: bad", "mission: !!python/object/apply:os.system [ls]", "Y013", "mission: "),
    "two documents": Bad("drones:", "---\ndrones:", "Y014", "---"),
    "nothing": Bad(MISSION, "", "Y015"),
    "NaN": Bad("radius: 4", "radius: .nan", "U006", "radius: "),
    "infinity": Bad("radius: 4", "radius: .inf", "U006", "radius: "),
    "1e300": Bad("[-40, -40, 10]", "[-40, -40, 1e300]", "U006", "1e300"),
    "short vector": Bad("[-40, -40, 10]", "[-40, -40]", "S008", "[-40, -40]"),
    "long vector": Bad("[-40, -40, 10]", "[-40, -40, 10, 1]", "S008", "10, 1]"),
    "wrong dimension": Bad("8 m/s", "8 s", "U002", "8 s"),
    "bare angle": Bad("hfov: 70 deg", "hfov: 70", "U003", "hfov"),
    "inverted range": Bad("[-90 deg, 30 deg]", "[30 deg, -90 deg]", "S013", "pitch: [30"),
    "unknown key": Bad("    target: tower\n", "    taget: tower\n", "S003", "taget"),
    "unknown name": Bad("    target: tower\n", "    target: towr\n", "N001", "towr"),
    "mission name": Bad("mission: bad", "mission: ../../bad", "S011", "mission: "),
    "file outside": Bad("file: track.csv", "file: ../track.csv", "S012", "file: "),
    "absolute file": Bad("file: track.csv", "file: /etc/passwd", "S012", "file: "),
    "missing file": Bad("file: track.csv", "file: nowhere.csv", "N008", "file: "),
    "link out of the folder": Bad("file: track.csv", "file: link.csv", "N010", "file: "),
    "malformed CSV": Bad("file: track.csv", "file: broken.csv", "N009", "file: "),
    "malformed GPX": Bad("file: track.csv", "file: broken.gpx", "N009", "file: "),
    "XML bomb": Bad("file: track.csv", "file: bomb.gpx", "N009", "file: "),
    "half a turn of view": Bad("hfov: 70 deg", "hfov: 180 deg", "S015", "hfov: "),
    "no aspect": Bad('"16:9"', '"16:0"', "S015", "16:0"),
    "underground": Bad("[-40, -40, 10]", "[-40, -40, -1]", "G001", "-40, -1]"),
    "inside a zone": Bad("[-40, -40, 10]", "[30, 0, 5]", "G002", "[30, 0, 5], look"),
    "inside the target": Bad("[-40, -40, 10]", "[1, 0, 10]", "G004", "[1, 0, 10]"),
    "target behind the camera": Bad("heading: 0 deg", "heading: 180 deg", "G008", "heading: 180"),
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files that the missions name, and one outside it."""
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.chdir(home)
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)
    (tmp_path / "track.csv").write_bytes(TRACK)
    (home / "track.csv").write_bytes(TRACK)
    (home / "link.csv").symlink_to(tmp_path / "track.csv")
    (home / "broken.csv").write_bytes(b"x,y,z\n0,-40\n\xff,oops,1e999\n")
    (home / "broken.gpx").write_bytes(b"<gpx><trk><trkseg><trkpt lat='x'/></trkseg>")
    (home / "bomb.gpx").write_bytes(
        b'<!DOCTYPE gpx [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><gpx><trk>&b;</trk></gpx>'
    )
    return home


def test_the_mission_itself_is_good(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("bad.yaml").write_text(MISSION)
    assert app.run(["check", "bad.yaml", "--format", "concise"]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.long
@pytest.mark.timeout(60)
@pytest.mark.parametrize("command", ["check", "plan"])
@pytest.mark.parametrize("name", BAD)
def test_it_is_refused(folder: Path, capsys: pytest.CaptureFixture[str], name: str, command: str) -> None:
    bad = BAD[name]
    assert MISSION.count(bad.old) == 1
    text = MISSION.replace(bad.old, bad.new)
    Path("bad.yaml").write_bytes(text.encode("utf-8", "surrogateescape"))
    before = set(folder.rglob("*"))
    assert app.run([command, "bad.yaml"]) == 1
    out, err = capsys.readouterr()
    said = out if command == "check" else err
    assert f"error[{bad.code}]" in said
    if bad.line is not None:
        line = max(n for n, content in enumerate(text.split("\n"), 1) if bad.line in content)
        assert f"--> bad.yaml:{line}:" in said
    assert "Traceback" not in out + err
    assert max(map(len, said.splitlines())) < 400
    assert set(folder.rglob("*")) == before
