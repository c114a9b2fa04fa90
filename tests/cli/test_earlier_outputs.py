"""A run that fails beside the outputs of an earlier one says that those are not its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import GOOD, Run

pytestmark = pytest.mark.slow

FAST = GOOD + "output: {emit: []}\n"
IMPOSSIBLE = FAST.replace("at: [0, -50, 15]", "at: [0, 0, 12]")
NOTE = (
    "note: {folder}/ still holds the outputs of an earlier run of mission `look`, not of this one: plan.json"
)


@pytest.mark.long
@pytest.mark.parametrize(("options", "folder"), [(("-o", "there"), "there"), ((), "out/look")])
def test_a_plan_that_fails_names_what_an_earlier_one_left(
    run: Run, tmp_path: Path, options: tuple[str, ...], folder: str
) -> None:
    mission = tmp_path / "look.yaml"
    mission.write_text(IMPOSSIBLE)
    assert "note:" not in run("plan", "look.yaml", *options).err.splitlines()[-1]
    mission.write_text(FAST)
    done = run("plan", "look.yaml", *options)
    assert done.code == 0
    assert "earlier run" not in done.err
    before = (tmp_path / folder / "plan.json").read_bytes()
    wrong = IMPOSSIBLE.replace("drone: cam1", "dron: cam1")
    for text, flags in ((IMPOSSIBLE, ()), (IMPOSSIBLE, ("--quiet",)), (wrong, ())):
        mission.write_text(text)
        done = run(*flags, "plan", "look.yaml", *options)
        assert done.code == 1
        assert done.out == ""
        assert done.err.splitlines()[-1] == NOTE.format(folder=folder)
        assert done.err.count("earlier run") == 1
    assert (tmp_path / folder / "plan.json").read_bytes() == before
    assert "earlier run" not in run("plan", "look.yaml", *options, "--stop-after", "resolve").err


def test_a_smaller_plan_names_what_a_larger_one_left(run: Run, tmp_path: Path) -> None:
    mission = tmp_path / "look.yaml"
    mission.write_text(GOOD + "output: {emit: [csv]}\n")
    assert "earlier" not in run("plan", "look.yaml").err
    (tmp_path / "out" / "look" / "cam9.plan").write_text("{}")
    mission.write_text(FAST)
    done = run("plan", "look.yaml")
    assert done.code == 0
    assert done.err.splitlines()[-1] == (
        "note: out/look/ also holds outputs of an earlier run, not of this plan: "
        "cam9.plan, framing.csv, trajectory.csv"
    )


def test_a_mission_with_letters_and_spaces_has_a_folder_of_its_own(run: Run, tmp_path: Path) -> None:
    (tmp_path / "look.yaml").write_text(FAST.replace("mission: look", "mission: Zürich See 2"))
    assert run("plan", "look.yaml").code == 0
    assert (tmp_path / "out" / "Zürich-See-2" / "plan.json").exists()
    (tmp_path / "look.yaml").write_text(IMPOSSIBLE.replace("mission: look", "mission: Zürich See 2"))
    assert "an earlier run of mission `Zürich See 2`" in run("plan", "look.yaml").err
