"""The check of all platforms: what it calls wrong, what it skips, and what it asks for."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from packaging.requirements import Requirement

from tests import platforms
from tests.platforms import NO_WHEELS, PLATFORMS, PROBE, PYTHONS, Answer, Question, Reply, judge

EVERYWHERE = Requirement("rich>=14")
LINUX = Requirement("toppra>=0.6.9; sys_platform == 'linux' and platform_machine == 'x86_64'")
REASONS = {"toppra": "built for Linux x86-64"}
COUNT = len(PLATFORMS) * len(PYTHONS)


def index(lacking: Callable[[Question], bool] = lambda _question: False) -> Callable[[Question], Reply]:
    """An index without wheels of toppra but for Linux x86-64, and without what ``lacking`` says."""

    def ask(question: Question) -> Reply:
        alone = question.requirements[0].startswith("toppra") and question.platform is not PLATFORMS[0]
        return Reply(Answer.LACKING, "gone") if alone or lacking(question) else Reply(Answer.WHEELS)

    return ask


def test_an_exception_that_is_one_is_held_to_be_true():
    verdict = judge((EVERYWHERE, LINUX), REASONS, index())
    assert (verdict.faults, verdict.skipped) == ((), ())
    assert len(verdict.held) == COUNT


def test_a_platform_without_a_wheel_is_wrong():
    mac = PLATFORMS[2]
    verdict = judge((EVERYWHERE,), {}, index(lambda q: q.platform is mac and q.python == "3.14" and q.deep))
    assert verdict.faults == ("aarch64-apple-darwin, Python 3.14: gone",)
    assert len(verdict.held) == COUNT - 1


def test_an_exception_that_has_wheels_by_now_is_wrong():
    verdict = judge((LINUX,), REASONS, lambda _question: Reply(Answer.WHEELS))
    assert len(verdict.faults) == COUNT - len(PYTHONS)
    assert "toppra>=0.6.9 has wheels, and its marker leaves it out" in verdict.faults[0]


@pytest.mark.parametrize(
    ("reasons", "fault"),
    [
        ({}, "toppra: no reason is stated"),
        ({**REASONS, "rich": "?"}, "rich: a reason is stated, but no marker"),
    ],
)
def test_markers_and_reasons_belong_together(reasons: dict[str, str], fault: str):
    assert judge((EVERYWHERE, LINUX), reasons, index()).faults == (fault,)


def test_without_an_index_nothing_is_wrong_and_every_platform_is_named():
    verdict = judge((EVERYWHERE,), {}, lambda _question: Reply(Answer.SILENCE, "Failed to fetch"))
    assert (verdict.faults, verdict.held) == ((), ())
    assert [line.partition(":")[0] for line in verdict.skipped] == [p.name for p in PLATFORMS]


def test_a_platform_that_the_index_has_nothing_for_is_skipped():
    windows = PLATFORMS[-1]
    verdict = judge((EVERYWHERE,), {}, index(lambda q: q.platform is windows))
    assert verdict.faults == ()
    assert verdict.skipped == ("x86_64-pc-windows-msvc: gone",)
    assert len(verdict.held) == COUNT - len(PYTHONS)


def test_an_index_that_falls_silent_is_told_of():
    whole = index()
    verdict = judge(
        (EVERYWHERE,), {}, lambda q: whole(q) if q.requirements == (PROBE,) else Reply(Answer.SILENCE, "gone")
    )
    assert (verdict.faults, verdict.held) == ((), ())
    assert len(verdict.skipped) == COUNT


def test_what_is_required_are_the_requirements_of_all_extras_and_plugins():
    names = {requirement.name for requirement in platforms.requirements()}
    assert {"typer", "numpy", "rerun-sdk", "casadi", "pytest"} <= names
    assert not {name for name in names if name.startswith("shotc")}
    marked = {requirement.name for requirement in platforms.exceptions(platforms.requirements())}
    assert marked == set(NO_WHEELS)


@pytest.mark.parametrize(
    ("stderr", "answer"),
    [
        (
            "error: Request failed after 3 retries in 6.6s\n cause: Failed to fetch: simple/rich/",
            Answer.SILENCE,
        ),
        ("error: No solution found ...\n hint: ... because the network was disabled", Answer.SILENCE),
        ("error: No solution found ... has no wheels with a matching platform tag", Answer.LACKING),
    ],
)
def test_uv_s_words_are_understood(stderr: str, answer: Answer, monkeypatch: pytest.MonkeyPatch):
    class Done:
        returncode = 1

    Done.stderr = stderr
    monkeypatch.setattr(platforms.subprocess, "run", lambda *_args, **_options: Done)
    assert platforms.ask_uv("uv", Question(PLATFORMS[0], "3.12", ("rich",))).answer is answer


def test_a_failure_of_uv_itself_is_raised(monkeypatch: pytest.MonkeyPatch):
    class Done:
        returncode = 2
        stderr = "error: unexpected argument"

    monkeypatch.setattr(platforms.subprocess, "run", lambda *_args, **_options: Done)
    with pytest.raises(RuntimeError, match="unexpected argument"):
        platforms.ask_uv("uv", Question(PLATFORMS[0], "3.12", ("rich",)))
