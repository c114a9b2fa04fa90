"""verify --against: a plan held to a mission file."""

from pathlib import Path

import pytest

from shotc.emit.plan_json import EMITTER
from shotc.ir.passes import PassContext
from shotc.passes.verify import Verify
from tests.cli.conftest import Run
from tests.support.film_plans import orbit_plan, orbit_text

pytestmark = pytest.mark.slow


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    verified = Verify().run(orbit_plan().trajectory, PassContext()).value
    assert verified is not None
    path = tmp_path / "plan.json"
    path.write_bytes(EMITTER.emit(verified).artifacts[0].data)
    return path


def held(run: Run, plan: Path, text: str) -> tuple[int, str]:
    plan.with_name("mission.yaml").write_text(text)
    done = run("verify", str(plan), "--against", str(plan.with_name("mission.yaml")))
    return done.code, done.out + done.err


def test_the_plan_of_the_file_holds(run: Run, plan: Path) -> None:
    code, said = held(run, plan, "# reviewed\n" + orbit_text())
    assert (code, "the plan holds" in said) == (0, True)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("40.0, 0.0, 20]", "40.0, 25.0, 20]", "keyframe 3, at is (40, 0, 20) in the plan, but (40, 25, 20)"),
        ("endurance: 20 min", "endurance: 15 min", "endurance is 1200 in the plan, but 900 in the mission"),
        ("in_frame: 100 %", "in_frame: 90 %", "in_frame is 1 in the plan, but 0.9 in the mission"),
        ("radius: 3,", "radius: 2,", "zone `tree`, solid, radius is 3 in the plan, but 2 in the mission"),
    ],
)
def test_another_mission_is_told_on_its_line(run: Run, plan: Path, old: str, new: str, said: str) -> None:
    text = orbit_text().replace(old, new)
    line = next(n for n, row in enumerate(text.splitlines(), 1) if new in row)
    code, err = held(run, plan, text)
    assert code == 1
    assert "error[V043]" in err
    assert said in " ".join(err.split())
    assert f"mission.yaml:{line}:" in err


def test_a_mission_at_fault_is_told(run: Run, plan: Path) -> None:
    code, err = held(run, plan, orbit_text().replace("target: tower", "target: spire"))
    assert code == 1
    assert "error[V043]" in err
    assert "error[N0" in err


def test_a_file_that_is_not_there(run: Run, plan: Path) -> None:
    done = run("verify", str(plan), "--against", str(plan.with_name("nowhere.yaml")))
    assert done.code == 1
    assert "cannot be read" in done.err
