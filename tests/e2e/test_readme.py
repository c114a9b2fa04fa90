"""What the README and the guides say is tried here."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.cli.app import COMMANDS
from shotc.diag.registry import FAMILIES, registry

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCS = sorted((ROOT / "shotc" / "docs").glob("*.md"))
CHANGES = ROOT / "shotc" / "CHANGELOG.md"
PAGES = [ROOT / "README.md", CHANGES, *DOCS, *sorted(ROOT.glob("plugins/*/README.md"))]


NUMBER = re.compile(r"\d+\.\d+")


def numbers(text):
    return [float(n) for n in NUMBER.findall(text)]


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


@pytest.mark.slow
def test_the_first_mission_plans_without_a_warning_but_the_missing_origin():
    mission = blocks("yaml")[0]
    done = compile_source(mission.encode(), "readme.yaml", None, PlanOptions())
    assert done.diagnostics == ()
    assert done.plan is not None


@pytest.mark.slow
def test_the_show_is_the_template_and_plans_without_a_warning():
    (mission,) = (block for block in blocks("yaml") if "kind: display" in block)
    template = (ROOT / "shotc" / "templates" / "drone-show.yaml").read_text(encoding="utf-8")
    assert mission == re.sub(r" +# <--.*", "", template[template.index("shotc: 1") :])
    done = compile_source(mission.encode(), "readme.yaml", None, PlanOptions())
    assert done.diagnostics == ()
    assert done.plan is not None


@pytest.mark.long
def test_the_answer_to_an_impossible_duration_is_what_it_says():
    """The block shows what `shotc plan` prints of the first mission with eighteen seconds for the shot."""
    from shotc.diag.render.text import render

    (shown,) = re.findall(r"^```\n(error\[.*?)\n```", README, re.DOTALL | re.MULTILINE)
    mission = blocks("yaml")[0]
    asked = re.search(r"timing: \{duration: [^}]*\}", shown)
    assert asked is not None
    short = mission.replace("    target: tower\n", f"    target: tower\n    {asked[0]}\n")
    done = compile_source(short.encode(), "tower.yaml", None, PlanOptions())
    assert done.plan is None
    said = render(done.diagnostics, done.sources)[: len(shown)]
    assert NUMBER.sub("#", said) == NUMBER.sub("#", shown)
    assert numbers(said) == pytest.approx(numbers(shown), rel=0.02)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_file_that_a_page_links_to_is_there(page):
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_and_code_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    for command in re.findall(r"(?:`|^)shotc ([a-z]+)\b", text, re.MULTILINE):
        assert command in COMMANDS, command
    for code in re.findall(rf"\b([{''.join(FAMILIES)}]\d{{3}})\b", text):
        assert code in registry(), code


def test_the_language_guide_names_every_kind():
    from shotc import plugins

    guide = (ROOT / "shotc" / "docs" / "language.md").read_text(encoding="utf-8")
    for kind in plugins.names("kinds"):
        assert f"`{kind}`" in guide, kind


def test_the_pre_commit_hook_runs_a_command_that_works():
    import yaml

    (hook,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    assert hook["entry"].split() == ["shotc", "check"]
    pattern = re.compile(hook["files"])
    assert pattern.search("tower.shot.yaml")
    assert pattern.search("missions/tower.yaml")
    assert not pattern.search(".github/workflows/ci.yaml")


def test_missions_of_the_guides_check_clean():
    for template in sorted((ROOT / "shotc" / "templates").glob("*.yaml")):
        assert check_source(template.read_bytes(), template.name, template.parent).diagnostics == ()


def test_the_architecture_page_draws_the_layers_that_are_enforced():
    import tomllib

    page = (ROOT / "shotc" / "docs" / "architecture.md").read_text(encoding="utf-8")
    (drawn,) = re.findall(r"^cli → .*$", page, re.MULTILINE)
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = contracts["contracts"][0]["layers"]
    assert drawn == " → ".join(layer.replace("shotc.", "") for layer in layers)
