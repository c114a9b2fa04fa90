"""Bad input of shows, one thing at a time: refused by the command on its line, and nothing is written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from shotc.cli import app
from tests.support.meshes import box_mesh, obj, ply, sphere_mesh

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: bad
fleets:
  swarm: {count: 30, separation: 1, rise: 8,
          layout: {grid: {spacing: 4, origin: [0, 0, 0]}}}
shots:
  - id: drawn
    kind: display
    fleet: swarm
    viewpoint: [0, -100, 2]
    frames:
      - {sphere: {center: [0, 0, 40], radius: 12}, hold: 2}
      - {model: {files: good.ply, units: m, center: [0, 0, 40]}, hold: 2}
      - {svg: {file: good.svg, center: [0, 0, 40], height: 30}, hold: 2}
      - {model: {files: walk*.obj, units: m, center: [0, 0, 40], period: 2}, hold: 2}
"""
SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    b'viewBox="0 0 9 9">%s</svg>'
)
SQUARE = b'<rect width="9" height="9"/>'


@dataclass(frozen=True)
class Bad:
    """What to put in place of what, the codes that may be raised, and the text of the line reported on."""

    old: str
    new: str
    codes: str
    line: str


BAD = {
    "empty mesh": Bad("good.ply", "empty.ply", "N009", "empty.ply"),
    "mesh of nothing": Bad("good.ply", "nothing.ply", "D050", "nothing.ply"),
    "mesh with NaN": Bad("good.ply", "nan.ply", "D050", "nan.ply"),
    "open mesh": Bad("good.ply", "open.ply", "D051", "open.ply"),
    "millimetres": Bad("good.ply", "large.ply", "D052", "large.ply"),
    "cut short": Bad("good.ply", "short.ply", "D050", "short.ply"),
    "frame sizes": Bad("walk*", "grow*", "D053", "grow*"),
    "no time": Bad("period: 2", "period: 0", "S U", "period: 0"),
    "no period": Bad(", period: 2", "", "D010", "walk*"),
    "more drones than fit": Bad("radius: 12", "radius: 0.2", "D018 D056", "radius: 0.2}"),
    "viewpoint inside": Bad("[0, -100, 2]", "[0, -5, 40]", "D013", "viewpoint"),
    "dense layout": Bad("spacing: 4", "spacing: 0.4", "D002", "spacing"),
    "script": Bad("good.svg", "script.svg", "D022", "script.svg"),
    "reference": Bad("good.svg", "refers.svg", "D022", "refers.svg"),
    "document type": Bad("good.svg", "typed.svg", "D022", "typed.svg"),
    "outside": Bad("good.ply", "../good.ply", "S012", "../good.ply"),
    "link outside": Bad("good.ply", "link.ply", "N010", "link.ply"),
    "gigabyte": Bad("good.ply", "huge.ply", "N D", "huge.ply"),
}


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all the files, good and bad, and one outside it."""
    folder = tmp_path_factory.mktemp("bad") / "home"
    folder.mkdir()
    box, ball = box_mesh((0, 0, 0), (24, 24, 24)), sphere_mesh(12, 10)
    holed = box.copy()
    holed[0, 0, 0] = np.nan
    binary = b"ply\nformat binary_little_endian 1.0\nelement vertex 500\n"
    binary += b"".join(b"property float %s\n" % axis for axis in (b"x", b"y", b"z")) + b"end_header\n"
    files = {
        "good.ply": ply(box),
        "empty.ply": b"",
        "nothing.ply": ply(box[:0]),
        "nan.ply": ply(holed),
        "open.ply": ply(box[:-1]),
        "large.ply": ply(1000 * box),
        "short.ply": binary + bytes(60),
        "good.svg": SVG % SQUARE,
        "script.svg": SVG % (SQUARE + b"<script>alert(1)</script>"),
        "refers.svg": SVG % (SQUARE + b'<image xlink:href="http://example.com/a.png" width="9" height="9"/>'),
        "typed.svg": b'<!DOCTYPE svg [<!ENTITY a "aaaa">]>' + SVG % SQUARE,
    }
    files |= {f"walk{k}.obj": obj(ball * (1 + 0.05 * k)) for k in range(3)}
    files |= {f"grow{k}.obj": obj(ball * 10**k) for k in range(3)}
    for name, data in files.items():
        (folder / name).write_bytes(data)
    (folder.parent / "good.ply").write_bytes(ply(box))
    (folder / "link.ply").symlink_to(folder.parent / "good.ply")
    with (folder / "huge.ply").open("wb") as huge:
        huge.truncate(2**30)
    return folder


@pytest.fixture(autouse=True)
def there(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work in that folder."""
    monkeypatch.chdir(home)
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)


def test_the_mission_itself_is_good(capsys: pytest.CaptureFixture[str]) -> None:
    Path("bad.yaml").write_text(MISSION)
    assert app.run(["plan", "bad.yaml", "--stop-after", "place-goals"]) == 0, capsys.readouterr().err


@pytest.mark.long
@pytest.mark.parametrize("name", BAD)
def test_it_is_refused(home: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    bad = BAD[name]
    assert MISSION.count(bad.old) == 1
    text = MISSION.replace(bad.old, bad.new)
    Path("bad.yaml").write_text(text)
    before = set(home.rglob("*"))
    assert app.run(["plan", "bad.yaml"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("error[") == 1, err
    code = err.split("error[")[1].split("]")[0]
    assert code.startswith(tuple(bad.codes.split())), err
    (line,) = (n for n, content in enumerate(text.split("\n"), 1) if bad.line in content)
    assert f"--> bad.yaml:{line}:" in err
    assert "Traceback" not in err
    assert set(home.rglob("*")) == before
