"""The command as a process: how it ends, what it leaves behind, and what it needs."""

from __future__ import annotations

import json
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.command import PLAN, SHOTC, SMALL, environment, run

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="signals, limits and device files"),
    pytest.mark.timeout(180),
    pytest.mark.xdist_group("command"),
]

WRONG = SMALL.replace("target: tower", "target: towr")
TABLES = {"plan.json", "trajectory.csv", "framing.csv"}
SURROUNDINGS = str(Path(__file__).parents[1] / "support" / "surroundings")
SOLVERS = "numpy,scipy,cvxpy,clarabel,toppra,matplotlib,pymap3d,rerun"


@pytest.fixture(scope="session")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a mission and its outputs."""
    folder = tmp_path_factory.mktemp("planned")
    (folder / "small.yaml").write_text(SMALL)
    result = run(*PLAN, "small.yaml", folder=folder)
    assert (result.code, result.err) == (0, "")
    return folder


@pytest.fixture
def place(planned: Path, tmp_path: Path) -> Path:
    """A copy of that folder to do harm in."""
    return Path(shutil.copytree(planned, tmp_path / "work"))


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.long
def test_a_plan_is_written_where_it_says(planned: Path) -> None:
    assert set(content(planned / "out" / "small")) == TABLES


@pytest.mark.long
def test_results_go_to_the_output_stream(place: Path) -> None:
    result = run(*PLAN, "small.yaml", "-o", "there", folder=place)
    assert (result.code, result.err) == (0, "")
    assert "planned and proved" in result.out
    assert "there/: plan.json, trajectory.csv, framing.csv" in result.out
    assert content(place / "there") == content(place / "out" / "small")
    assert "\x1b" not in result.out


@pytest.mark.long
def test_a_mission_comes_from_standard_input(place: Path) -> None:
    result = run(*PLAN, "-", "-o", "piped", folder=place, stdin=SMALL.encode())
    assert (result.code, result.err) == (0, "")
    for name in ("trajectory.csv", "framing.csv"):
        assert (place / "piped" / name).read_bytes() == (place / "out" / "small" / name).read_bytes()


@pytest.mark.long
def test_a_rejected_mission_writes_nothing(place: Path) -> None:
    (place / "wrong.yaml").write_text(WRONG)
    before = content(place / "out" / "small")
    result = run(*PLAN, "wrong.yaml", folder=place)
    assert (result.code, result.out) == (1, "")
    (report,) = result.reports
    assert (report.code, report.line) == ("N001", 8)
    assert "tower" in report.help
    assert content(place / "out" / "small") == before


@pytest.mark.long
@pytest.mark.parametrize(
    "arguments",
    [
        ["--refiner", "nope"],
        ["--emit", "csv,nope"],
        ["--stop-after", "emit"],
        ["--dump-ir", "nope"],
        ["--seed", "x"],
        ["second.yaml", "--time-passes"],
    ],
    ids=" ".join,
)
def test_usage_errors(planned: Path, arguments: list[str]) -> None:
    result = run(*PLAN, "small.yaml", *arguments, folder=planned)
    assert (result.code, result.out) == (2, "")
    assert result.err.startswith("error: ")
    assert result.err.endswith("try `shotc plan --help`\n")


@pytest.mark.long
@pytest.mark.parametrize("moment", ["shotc.passes.place_keyframes", "clarabel", "matplotlib", "1", "4"])
def test_an_interrupt_leaves_the_old_files(place: Path, moment: str) -> None:
    """While loading, while solving, while drawing, while writing the first file and the last one."""
    before = content(place / "out" / "small")
    (place / "small.yaml").write_text(SMALL.replace("[0, -50, 15]", "[0, -52, 15]"))
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_INTERRUPT": moment}
    result = run(*PLAN, "small.yaml", "--emit", "csv,storyboard", "--jobs", "2", folder=place, env=env)
    assert (result.code, result.out, result.err) == (130, "", "interrupted\n")
    assert content(place / "out" / "small") == before


@pytest.mark.long
@pytest.mark.parametrize("emit", ["csv", "rerun"])
def test_a_full_disk_leaves_the_old_files(place: Path, emit: str) -> None:
    before = content(place / "out" / "small")
    (place / "small.yaml").write_text(SMALL.replace("[0, -50, 15]", "[0, -52, 15]"))
    done = subprocess.run(
        [*SHOTC, *PLAN, "small.yaml", "--emit", emit],
        cwd=place,
        # Python writes what fits of a compiled module, and whoever imports it next fails.
        env=environment({"PYTHONDONTWRITEBYTECODE": "1"}),
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)),
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("error[E901]: the outputs cannot be written: ")
    assert content(place / "out" / "small") == before


@pytest.mark.long
@pytest.mark.parametrize("output", ["taken", "/proc/nowhere"])
def test_a_folder_that_cannot_be_written(place: Path, output: str) -> None:
    (place / "taken").write_text("a file")
    result = run(*PLAN, "small.yaml", "-o", output, folder=place)
    assert (result.code, result.out) == (1, "")
    assert [report.code for report in result.reports] == ["E901"]
    assert (place / "taken").read_text() == "a file"


@pytest.mark.long
def test_a_reader_that_leaves_early_is_no_error(place: Path) -> None:
    with subprocess.Popen(
        [*SHOTC, *PLAN, "small.yaml", "-o", "there"],
        cwd=place,
        env=environment({}),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.stderr is not None
        assert process.stderr.read() == b""
        assert process.wait(60) == 141
    assert set(content(place / "there")) == TABLES


@pytest.mark.long
@pytest.mark.parametrize(
    "library", ["clarabel", "matplotlib", SOLVERS], ids=["clarabel", "matplotlib", "all"]
)
def test_planning_without_its_libraries_says_what_to_install(planned: Path, library: str) -> None:
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": library}
    result = run(*PLAN, "small.yaml", "-o", "none", folder=planned, env=env)
    assert (result.code, result.out) == (1, "")
    (report,) = result.reports
    assert report.code == "P004"
    assert library.partition(",")[0] in report.text
    assert "pip install" in report.help
    assert "[plan]" in report.help
    assert not (planned / "none").exists()


@pytest.mark.long
def test_planning_without_toppra_gives_a_plan_that_is_proved(place: Path) -> None:
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": "toppra"}
    result = run(*PLAN, "small.yaml", "-o", "there", folder=place, env=env)
    assert (result.code, result.reports) == (0, [])
    assert run("verify", "there", folder=place, env=env).code == 0
    code = "from importlib.util import find_spec; print(find_spec('toppra'))"
    seen = subprocess.run([sys.executable, "-c", code], env=environment(env), capture_output=True, check=True)
    assert seen.stdout.strip() == b"None"


@pytest.mark.long
@pytest.mark.parametrize("arguments", [["verify"], ["emit"], ["diff", "out/small"]], ids=lambda a: a[0])
def test_reading_a_plan_without_libraries_says_what_to_install(planned: Path, arguments: list[str]) -> None:
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": SOLVERS}
    result = run(*arguments, "out/small", folder=planned, env=env)
    assert result.code == 1
    assert {report.code for report in result.reports} == {"P004"}


@pytest.mark.long
def test_an_output_without_its_library_is_left_out(place: Path) -> None:
    (place / "small.yaml").write_text(SMALL.replace("[csv]", "[rerun, csv]"))
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": "rerun"}
    result = run(*PLAN, "small.yaml", "-o", "there", folder=place, env=env)
    assert result.code == 0
    (report,) = result.reports
    assert (report.severity, report.code) == ("warning", "P005")
    assert "[view]" in report.help
    assert set(content(place / "there")) == TABLES


@pytest.mark.long
@pytest.mark.parametrize(
    "arguments", [["check", "small.yaml"], ["list", "kinds"], ["explain", "K004"]], ids=" ".join
)
def test_the_base_install_needs_no_library(planned: Path, arguments: list[str]) -> None:
    env = {"PYTHONPATH": SURROUNDINGS, "TEST_HIDE": SOLVERS + ",casadi"}
    result = run(*arguments, folder=planned, env=env)
    assert result.code == 0
    assert result.reports == []


@pytest.mark.slow
def test_check_loads_no_heavy_module(planned: Path) -> None:
    heavy = {*SOLVERS.split(","), "casadi"}
    code = (
        "import sys; from shotc.cli.app import run\n"
        "code = run(['check', 'small.yaml', '-q'])\n"
        f"print(code, sorted({heavy} & {{name.partition('.')[0] for name in sys.modules}}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=planned,
        env=environment({}),
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "0 []\n"


@pytest.mark.long
@pytest.mark.parametrize("name", ["json", "sarif", "github", "concise"])
def test_reports_for_machines(place: Path, name: str) -> None:
    (place / "wrong.yaml").write_text(WRONG)
    result = run("check", "wrong.yaml", "--format", name, folder=place)
    assert result.code == 1
    if name in ("json", "sarif"):
        document = json.loads(result.out)
        found = document["diagnostics"] if name == "json" else document["runs"][0]["results"]
        assert [item.get("code") or item.get("ruleId") for item in found] == ["N001"]
    elif name == "github":
        assert result.out.startswith("::error title=N001 unknown-target,file=wrong.yaml,line=8,col=")
    else:
        assert result.out.startswith("wrong.yaml:8:")


@pytest.mark.long
def test_no_colour_where_none_is_wanted(place: Path) -> None:
    (place / "wrong.yaml").write_text(WRONG)
    for env in ({"NO_COLOR": "1", "FORCE_COLOR": "1"}, {}):
        assert "\x1b" not in run("check", "wrong.yaml", folder=place, env=env).out
    assert "\x1b[1;31merror[N001]" in run("check", "wrong.yaml", folder=place, env={"FORCE_COLOR": "1"}).out
