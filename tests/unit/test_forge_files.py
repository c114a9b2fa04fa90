"""What a public forge reads: workflows that run what there is, pages whose links lead somewhere, examples."""

from __future__ import annotations

import ast
import re
import sys
import textwrap
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
import yaml

from shotc import pipeline, plugins
from shotc.diag.registry import registry
from shotc.ir.passes import PassContext
from tests.support.front_passes import placed
from tests.unit.kinds.test_generated_paths import HEAD

ROOT = Path(__file__).parents[2]
FORGE = ROOT / ".github"
WORKFLOWS = sorted((FORGE / "workflows").glob("*.yml"))
PAGES = sorted(FORGE.glob("*.md"))
CONTRIBUTING = (FORGE / "CONTRIBUTING.md").read_text(encoding="utf-8")
BLOCKS = [textwrap.dedent(b) for b in re.findall(r"```python\n(.*?)```", CONTRIBUTING, re.DOTALL)]
TARGETS = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))


def steps(workflow: Path) -> list[dict[str, object]]:
    jobs = yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"].values()
    return [step for job in jobs for step in job["steps"]]


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_runs_tasks_of_the_makefile_and_pins_its_actions_by_major_version(workflow: Path) -> None:
    text = workflow.read_text(encoding="utf-8")
    assert "secrets." not in text
    for step in steps(workflow):
        if "uses" in step:
            assert re.fullmatch(r"actions/[a-z-]+@v\d+", str(step["uses"])), step
        for task in re.findall(r"^make ([a-z-]+)", str(step.get("run", ""))):
            assert task in TARGETS, task


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_and_tasks_of_a_page_are_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", text):
        assert (page.parent / target).exists(), target
    for task in re.findall(r"(?:`|^)make ([a-z-]+)\b", text, re.MULTILINE):
        assert task in TARGETS, task


def test_the_files_that_the_examples_change_are_there() -> None:
    named = set(re.findall(r"`((?:shotc|tests|plugins)/[\w/.-]+\.\w+)`", CONTRIBUTING))
    new = {"sway", "thin_keyframes", "cue_sheet", "test_sway", "test_cue_sheet", "test_aim"}
    assert {path for path in named if Path(path).stem not in new and not (ROOT / path).exists()} == set()
    assert not any((ROOT / path).exists() for path in named if Path(path).stem in new)


def test_the_step_of_the_examples_fits_the_route() -> None:
    (written,) = re.findall(r"`(RouteStep\(.*?\))`", CONTRIBUTING)
    step = eval(written, vars(pipeline))
    following = pipeline.FILM[0]
    assert (step.takes, step.gives) == (pipeline.FRONT[-1].gives, following.takes)


def test_the_names_that_the_examples_extend_are_in_the_files_that_they_name() -> None:
    pairs = re.findall(r"`([\w_]+)`\s+(?:of|in)\s+`((?:shotc|tests)/[\w/.]+\.py)`", CONTRIBUTING)
    assert {name for name, _ in pairs} == {"MODULES", "parameters", "CODES", "GRAMMAR", "MISSION"}
    for name, path in pairs:
        assert re.search(rf"^{name}\b", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE), name


def test_the_version_of_python_is_told_once() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    versions = [c.rpartition(" ")[2] for c in project["classifiers"] if re.search(r":: 3\.\d+$", c)]
    assert f">={versions[0]}" == project["requires-python"]
    assert "urls" not in project, "its blank in CONTRIBUTING.md is filled in: take it away there, and here"


def test_the_examples_take_names_and_codes_that_are_free() -> None:
    numbers = re.findall(r"\bF\d{3}\b", CONTRIBUTING)
    assert numbers
    assert not set(numbers) & set(registry())
    for group in ("kinds", "emitters", "refiners"):
        for name in re.findall(r"`(\w+) = \"\w+(?:\.\w+)*:\w+\"`", CONTRIBUTING):
            assert name not in plugins.names(group)


def test_the_examples_import_what_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    example = ModuleType("example")
    monkeypatch.setitem(sys.modules, "example", example)
    modules = [block for block in BLOCKS if block.startswith('"""')]
    assert len(modules) == 3
    for block in modules:
        exec(compile(block, "CONTRIBUTING.md", "exec"), vars(example))
    for block in set(BLOCKS) - set(modules):
        ast.parse(block.strip())


def test_the_pass_of_the_examples_thins_and_keeps_what_is_placed() -> None:
    (block,) = (b for b in BLOCKS if "class ThinKeyframes" in b)
    made: dict[str, object] = {"__name__": "example"}
    exec(compile(block, "CONTRIBUTING.md", "exec"), made)
    mission = HEAD + "  - {id: a, drone: cam1, kind: orbit, target: tower, radius: 50, altitude: 20}\n"
    before, found = placed(mission)
    assert before is not None, found
    (shot,) = before.shots
    twice = tuple(k for keyframe in shot.keyframes for k in (keyframe, keyframe))
    doubled = before._replace(shots=(shot._replace(keyframes=twice),))
    after = made["ThinKeyframes"]().run(doubled, PassContext()).value
    assert after == before
    assert made["ThinKeyframes"].name not in pipeline.PASS_NAMES
