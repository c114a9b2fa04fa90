"""A refined path that a later pass refuses although the convex one can be flown: the refiner is blamed."""

from __future__ import annotations

import pytest

from shotc import api, plugins
from shotc.diag.model import Diagnostic
from shotc.ir.passes import Outcome
from tests.support.bad_refiners import PASS, ROUND, Odd, along, bumped, text
from tests.support.remedies.apply import remedies

pytestmark = pytest.mark.slow

DURATION = 22


@pytest.fixture
def planned(monkeypatch):
    """Return a function that plans the mission by a refiner which does what it is told."""

    def plan(act, source):
        odd = plugins.Source(Odd(act), "odd-maker", "")
        monkeypatch.setattr(plugins, "one", lambda group, name: odd)
        return api.compile_source(source.encode(), "yard.yaml", None, api.PlanOptions(refiner="odd"))

    return plan


def detour(ir):
    """Refine the round to a way up and down that takes far longer."""
    return Outcome(bumped(ir, ROUND, along(2, 25.0)))


def hurried(*optional: str, seconds: int = DURATION) -> str:
    """Return the mission with a duration of the round that its convex path can be flown in."""
    return text(*optional).replace(
        "    radius: 25\n", f"    timing: {{duration: {seconds}}}\n    radius: 25\n"
    )


def test_the_convex_path_can_be_flown_in_that_time(planned):
    assert planned(Outcome, hurried()).plan is not None


def test_a_refiner_that_makes_a_shot_too_long_is_blamed(planned):
    done = planned(detour, hurried())
    assert done.plan is None
    (fault,) = done.diagnostics
    assert fault.code == "R009"
    assert "`odd` of package odd-maker" in fault.message
    assert f"is given {DURATION} s" in fault.notes[0]
    assert fault.labels[0].span.line == hurried()[: hurried().index("timing:")].count("\n") + 1
    assert "--refiner none" in fault.help


def test_a_refiner_that_breaks_a_promise_is_blamed(planned):
    promised = text().replace("    radius: 25\n", "    require: {screen_error: 0.02}\n    radius: 25\n")
    done = planned(lambda ir: Outcome(bumped(ir, ROUND, along(4, 0.3))), promised)
    assert [d.code for d in done.diagnostics] == ["R009"]
    assert "0.02 is promised at most" in done.diagnostics[0].notes[0]


def test_the_convex_path_is_flown_where_every_refined_shot_accepts_it(planned):
    done = planned(detour, hurried(ROUND))
    assert done.plan is not None
    assert [d.code for d in done.diagnostics] == ["R003", "R014"]
    assert "shot `round`" in done.diagnostics[0].message
    assert "shot `pass` is not refined: refiner `odd`" in done.diagnostics[1].message
    assert "none that can be flown" in str(dict(done.plan.trajectory.stats)["round.refined"])
    (flown,) = (p for p in done.plan.trajectory.drones[0].phases if p.shot == ROUND)
    assert flown.end - flown.start == pytest.approx(DURATION, abs=1e-6)
    assert [report.name for report in done.reports][-3:] == ["refine-path", "parameterize-time", "verify"]


def test_a_shot_that_was_not_refined_need_not_accept_anything(planned):
    assert planned(detour, hurried(ROUND)).plan is not None
    assert planned(detour, hurried(PASS)).plan is None


def test_what_no_path_can_meet_is_not_the_refiner_s_fault(planned):
    done = planned(detour, hurried(seconds=7))
    assert [d.code for d in done.diagnostics] == ["T001"]


def fails(ir):
    raise RuntimeError("no luck")


def test_a_duration_that_is_too_short_is_told_as_that_of_the_refined_path_and_of_the_convex_one(planned):
    (alone,) = planned(Outcome, hurried(seconds=7)).diagnostics
    (fault,) = planned(detour, hurried(seconds=7)).diagnostics
    assert fault.code == alone.code == "T001"
    assert "is the shortest possible" in alone.message
    assert "is the shortest possible on the path of refiner `odd`" in fault.message
    assert fault.notes[-1] == f"the convex path is too slow, too: {alone.message}"


def lost(shot, code="R012"):
    """Refine nothing, and say that a shot has no path."""

    def act(ir):
        found = next(s for s in ir.keyframes.mission.shots if s.id == shot)
        label = ir.keyframes.mission.origins.key(found.path)
        return Outcome(ir, (Diagnostic(code, "no path", (label,)),))

    return act


def test_a_refiner_that_fails_on_a_mission_with_a_good_convex_path_says_so_and_how_to_keep_it(planned):
    (fault,) = planned(fails, text()).diagnostics
    assert fault.code == "R001"
    assert fault.notes[-1] == "the convex path keeps every limit and promise"
    assert "let all shots fly the convex path by `refine: {optional: true}`" in fault.help
    assert "--refiner none" in fault.help
    assert planned(fails, text(PASS, ROUND)).plan is not None


def test_a_shot_that_cannot_be_refined_says_that_its_convex_path_is_good_and_what_keeps_it(planned):
    (fault,) = planned(lost(ROUND), text()).diagnostics
    assert "the convex path of shot `round` keeps every limit and promise" in fault.notes
    assert "let shot `round` fly the convex path by `refine: {optional: true}`" in fault.help
    assert planned(lost(ROUND), text(ROUND)).plan is not None


@pytest.mark.parametrize("code", ["R010", "R011", "R012"])
def test_what_the_help_of_a_solver_s_fault_says_does_when_it_is_written(planned, code):
    (fault,) = planned(lost(ROUND, code), text()).diagnostics
    (remedy,) = remedies(text(), fault)
    made = (planned(lost(ROUND, code), mission) for mission in remedy.missions)
    assert any(one.plan is not None for one in made)


@pytest.mark.parametrize("act", [fails, lost(ROUND)])
def test_a_convex_path_that_would_not_do_is_not_offered(planned, act):
    (fault,) = (d for d in planned(act, hurried(seconds=7)).diagnostics if d.code[0] == "R")
    assert "cannot be flown either: T001" in fault.notes[-1]
    assert "refine:" not in fault.help
    assert "--refiner none" not in fault.help


STEEP = """\
  - id: under
    kind: keyframes
    drone: cam
    target: mast
    composition: center
    keyframes:
      - {at: [-20, 6, 16], look_at: mast}
      - {at: [20, -6, 16], look_at: mast}
"""
"""The way from one keyframe to the other leads over the mast, too steep for the gimbal."""


def said(planned, act):
    return [d.code for d in planned(act, text() + STEEP).diagnostics]


def test_what_the_convex_path_cannot_frame_is_told_where_it_is_flown(planned):
    assert "Q007" in said(planned, Outcome)
    assert "Q007" in said(planned, lambda ir: Outcome(bumped(ir, ROUND, along(2, 0.5))))


def test_of_a_refined_path_verification_tells_what_is_not_framed(planned):
    found = said(planned, lambda ir: Outcome(bumped(ir, "under", along(2, 0.5))))
    assert "Q007" not in found
    assert "V032" in found
