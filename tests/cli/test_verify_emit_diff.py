"""verify, emit and diff: what they print where, what they write, and how they end."""

import json
import re
from hashlib import sha256
from pathlib import Path

import pytest

from shotc.emit.plan_json import EMITTER
from shotc.ir.passes import PassContext
from shotc.passes.verify import Verify
from shotc.planfile.write import seal
from tests.cli.conftest import GOOD, Run
from tests.support.film_plans import orbit_plan

pytestmark = pytest.mark.slow


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    verified = Verify().run(orbit_plan().trajectory, PassContext()).value
    assert verified is not None
    path = tmp_path / "out" / "plan.json"
    path.parent.mkdir()
    path.write_bytes(EMITTER.emit(verified).artifacts[0].data)
    return path


def edited(plan: Path, old: str, new: str, name: str = "edited.json") -> Path:
    text = plan.read_text()
    assert old in text
    path = plan.with_name(name)
    path.write_text(text.replace(old, new))
    return path


def test_verify_prints_the_certificate(run: Run, plan: Path) -> None:
    done = run("verify", str(plan))
    assert done.code == 0
    assert "speed" in done.out
    assert "every instant" in done.out
    assert "BROKEN" not in done.out
    assert "the plan holds" in done.out
    assert run("verify", str(plan.parent)).out == done.out


def test_verify_marks_what_an_edit_breaks(run: Run, plan: Path) -> None:
    done = run("verify", str(edited(plan, '"speed": 8.0', '"speed": 7.5')))
    assert done.code == 1
    assert "BROKEN  speed" in done.out
    assert "error[V001]" in done.err
    assert "error[V040]" in done.err
    assert "7.854 m/s" in done.err


def rewritten(plan: Path, document: dict) -> Path:
    path = plan.with_name("rewritten.json")
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize(
    ("field", "said"),
    [
        (
            "worst",
            r"cam1: speed: the worst value is 7\.85402 m/s in the certificate, 7\.85399 m/s",
        ),
        ("holds", r"cam1: speed: it is broken by the certificate, and holds by the plan"),
        ("hard", r"cam1: speed: it is not required by the certificate, and is required by the plan"),
    ],
)
def test_verify_names_the_field_that_differs(run: Run, plan: Path, field: str, said: str) -> None:
    document = json.loads(plan.read_text())
    speed = next(c for c in document["certificate"] if c["constraint"] == "speed")
    speed[field] = speed[field] + 3e-5 if field == "worst" else not speed[field]
    done = run("verify", str(rewritten(plan, document)))
    assert done.code == 1
    assert done.err.count("error[V040]") == 1
    assert re.search(said, " ".join(done.err.split()))


def test_a_certificate_of_another_version_is_one_fault(run: Run, plan: Path) -> None:
    document = json.loads(plan.read_text())
    document["tool"]["version"] = "0.0.1"
    assert run("verify", str(rewritten(plan, document))).code == 0
    for claim in document["certificate"]:
        claim["worst"] = None if claim["worst"] is None else claim["worst"] + 1.0
    done = run("verify", str(rewritten(plan, document)))
    assert done.code == 1
    assert done.err.count("error[V040]") == 1
    assert "claims of the certificate differ" in done.err
    assert "the file was written by shotc 0.0.1" in done.err


def test_verify_as_json(run: Run, plan: Path) -> None:
    good = json.loads(run("verify", str(plan), "--format", "json").out)
    assert good["holds"] is True
    assert good["diagnostics"] == []
    speed = next(c for c in good["certificate"] if c["constraint"] == "speed")
    assert (speed["limit"], speed["method"], speed["hard"]) == (8.0, "bounded", True)
    bad = run("verify", str(edited(plan, '"speed": 8.0', '"speed": 7.5')), "--format", "json")
    assert bad.code == 1
    found = json.loads(bad.out)
    assert found["holds"] is False
    assert {d["code"] for d in found["diagnostics"]} == {"V001", "V040", "V041"}


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"format": "shotc-plan", "version": 1}', "\0" * 9, "[" * 99999]
)
@pytest.mark.parametrize("command", ["verify", "emit"])
def test_no_plan_is_told_without_a_traceback(run: Run, tmp_path: Path, command: str, text: str) -> None:
    (tmp_path / "junk.json").write_text(text)
    done = run(command, "junk.json")
    assert done.code == 1
    assert "error[E00" in done.err
    assert "Traceback" not in done.err
    assert list(tmp_path.iterdir()) == [tmp_path / "junk.json"]


@pytest.mark.parametrize("text", [GOOD, '{"shotc": 1, "mission": "look"}'])
@pytest.mark.parametrize("command", ["verify", "emit"])
def test_a_mission_in_place_of_a_plan(run: Run, tmp_path: Path, command: str, text: str) -> None:
    (tmp_path / "m.yaml").write_text(text)
    done = run(command, "m.yaml")
    assert done.code == 1
    assert "this is a mission, not a plan" in done.err
    assert "run `shotc plan` on it first" in done.err


@pytest.mark.parametrize("command", ["check", "plan"])
def test_a_plan_in_place_of_a_mission(run: Run, plan: Path, command: str) -> None:
    done = run(command, str(plan))
    assert done.code == 1
    assert "error[S017]: this is a plan, not a mission" in done.out + done.err
    assert (done.out + done.err).count("error[") == 1


def test_a_file_that_is_not_there(run: Run) -> None:
    for arguments in (["verify", "nowhere.json"], ["emit", "nowhere.json"], ["diff", "a.json", "b.json"]):
        done = run(*arguments)
        assert done.code == 1
        assert "cannot be read" in done.err


@pytest.mark.slow
def test_emit_writes_beside_the_plan_or_elsewhere(run: Run, plan: Path, tmp_path: Path) -> None:
    before = plan.read_bytes()
    assert run("emit", str(plan), "--emit", "csv").code == 0
    assert sorted(p.name for p in plan.parent.iterdir()) == ["framing.csv", "plan.json", "trajectory.csv"]
    assert plan.read_bytes() == before
    done = run("emit", str(plan.parent), "--emit", "csv", "-o", "tables")
    assert done.out.split() == ["tables/trajectory.csv", "tables/framing.csv"]
    assert sorted(p.name for p in (tmp_path / "tables").iterdir()) == ["framing.csv", "trajectory.csv"]
    assert (tmp_path / "tables" / "framing.csv").read_bytes() == (plan.parent / "framing.csv").read_bytes()


@pytest.mark.slow
def test_emit_does_not_write_the_plan_again(run: Run, plan: Path) -> None:
    text = plan.read_text()
    plan.write_text(text.replace("{", "{ ", 1))  # as good, and not as shotc writes it
    assert run("emit", str(plan), "--emit", "csv").code == 0
    assert plan.read_text() == text.replace("{", "{ ", 1)
    nothing = run("emit", str(plan), "--emit", "", "-o", "empty")
    assert (nothing.code, nothing.out) == (0, "")
    assert "nothing is written" in nothing.err
    assert not Path("empty").exists()


def test_an_output_that_this_plan_cannot_have_is_an_error_with_its_reason(run: Run, plan: Path) -> None:
    done = run("emit", str(plan), "--emit", "skyc,csv", "-o", "tables")
    assert done.code == 1
    assert "error[E114]: output `skyc` has no file for this plan" in done.err
    assert "it holds the show of a fleet, and the mission has none" in done.err
    assert {path.name for path in Path("tables").iterdir()} == {"trajectory.csv", "framing.csv"}


def test_emit_refuses_a_broken_plan_and_unknown_emitters(run: Run, plan: Path) -> None:
    broken = edited(plan, '"speed": 8.0', '"speed": 7.5')
    done = run("emit", str(broken), "--emit", "csv", "-o", "tables")
    assert done.code == 1
    assert not Path("tables").exists()
    assert run("emit", str(plan), "--emit", "kmz").code == 2


@pytest.mark.slow
def test_diff_of_a_plan_with_itself_and_with_another(run: Run, plan: Path) -> None:
    same = run("diff", str(plan), str(plan))
    assert same.code == 0
    assert "same path" in same.out
    assert "the certificates say the same" in same.out
    mission = orbit_plan(origin=False).trajectory
    other = Verify().run(mission, PassContext()).value
    assert other is not None
    data = EMITTER.emit(other).artifacts[0].data.decode()
    text = data.replace('"endurance": 1200.0', '"endurance": 900.0').replace(
        '"limit": 1200.0', '"limit": 900.0'
    )
    value = json.loads(text.replace("endurance: 20 min", "endurance: 15 min"))
    value["mission_sha256"] = seal(value["mission"])
    value["source"]["sha256"] = sha256("\n".join(value["source"]["text"]).encode()).hexdigest()
    plan.with_name("other.json").write_text(json.dumps(value))
    done = run("diff", str(plan), str(plan.with_name("other.json")))
    assert done.code == 0
    assert "1200 s -> 900 s" in done.out
