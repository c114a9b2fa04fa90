"""What a refiner may do to shots on their own clock, and what becomes of the rest."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from shotc import api, plugins
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.passes import Outcome
from shotc.ir.path import BODY_YAW, CAM_PITCH, ClockLeg, PathIR, TimedPath, X, Y, Z
from tests.support.bad_refiners import Odd, along, refine, returns
from tests.support.records import replace

pytestmark = pytest.mark.slow

MISSION = """\
shotc: 1
mission: run
world: {zones: {shed: {keep: out, box: {center: [35, 8, 3], size: [3, 3, 8]}}}}
targets:
  runner: {track: {points: [[0, 0, 0.9], [90, 0, 0.9]], speed: 2 m/s}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [30, -20, 0], gimbal: {pitch: [-60 deg, 20 deg]}}}
shots:
  - {id: by, kind: lateral, drone: cam, target: runner, side: right, distance: 8, altitude: 4,
     timing: {start: 14, duration: 8}}
  - {id: after, kind: chase, drone: cam, target: runner, distance: 8, altitude: 4, timing: {duration: 6}}
"""
BY, AFTER = "by", "after"
OPTIONAL = "{id: by, refine: {optional: true}, "


def text(*, optional: bool = False) -> str:
    return MISSION.replace("{id: by, ", OPTIONAL) if optional else MISSION


@cache
def guide(optional: bool = False) -> PathIR:
    options = api.PlanOptions(refiner="none", stop_after="solve-path-qp")
    return api.compile_source(text(optional=optional).encode(), "run.yaml", None, options).reports[-1].output


def leg(ir: PathIR, shot: str = BY) -> ClockLeg:
    return next(one for one in ir.timed[0].legs if one.shot == shot)


def with_leg(ir: PathIR, changed: ClockLeg) -> PathIR:
    legs = tuple(changed if one.shot == changed.shot else one for one in ir.timed[0].legs)
    return replace(ir, timed=(TimedPath(ir.timed[0].drone, legs),))


def bent(ir: PathIR, by: list[float], shot: str = BY) -> PathIR:
    """Bend a shot by a smooth bump, as large as ``by``."""
    one = leg(ir, shot)
    t = one.curve.breaks
    share, span = (t - t[0]) / (t[-1] - t[0]), t[-1] - t[0]
    bump = np.polynomial.Polynomial([0, 1, -1]) ** 3 * 64
    rows = [bump.deriv(k)(share)[:, None] * np.array(by) / span**k for k in (1, 2)]
    ctrl = one.curve.ctrl + quintic_hermite(t, bump(share)[:, None] * np.array(by), *rows).ctrl
    return with_leg(ir, replace(one, curve=Piecewise(t, ctrl)))


def touched(ir: PathIR, piece: int, point: int, channel: int, by: float) -> PathIR:
    ctrl = leg(ir).curve.ctrl.copy()
    ctrl[piece, point, channel] += by
    return with_leg(ir, replace(leg(ir), curve=Piecewise(leg(ir).curve.breaks, ctrl)))


def not_a_number(ir: PathIR) -> PathIR:
    made = Piecewise(leg(ir).curve.breaks, leg(ir).curve.ctrl)
    ctrl = made.ctrl.copy()
    ctrl[1, 2, 0] = np.nan
    object.__setattr__(made, "ctrl", ctrl)
    return with_leg(ir, replace(leg(ir), curve=made))


def later(ir: PathIR) -> PathIR:
    curve = leg(ir).curve
    return with_leg(ir, replace(leg(ir), curve=Piecewise(curve.breaks + 1e-6, curve.ctrl)))


def transit_moved(ir: PathIR) -> PathIR:
    legs = list(ir.timed[0].legs)
    k = next(i for i, one in enumerate(legs) if not isinstance(one, ClockLeg) and one.phase == "transit")
    legs[k] = replace(legs[k], pace=0.5)
    return replace(ir, timed=(TimedPath("cam", tuple(legs)),))


FAULTS = {
    "clock": (lambda ir: with_leg(ir, replace(leg(ir), start=leg(ir).start + 1e-6)), "R005", "another time"),
    "later": (later, "R002", "more or less"),
    "framing": (lambda ir: with_leg(ir, replace(leg(ir), framing=())), "R005", "frames other targets"),
    "ends": (lambda ir: touched(ir, -1, 5, X, 1e-6), "R002", "it ends 1e-06"),
    "rest": (lambda ir: touched(ir, 0, 1, Y, 1e-3), "R002", "at rest"),
    "jump": (lambda ir: touched(ir, 8, 2, X, 1e-2), "R002", "jumps"),
    "nan": (not_a_number, "R002", "not finite"),
    "zone": (lambda ir: bent(ir, along(Y, 16.0)), "R006", "zone `shed`"),
    "ground": (lambda ir: bent(ir, along(Z, -4.5)), "R006", "the ground"),
    "pitch": (lambda ir: bent(ir, along(CAM_PITCH, -1.0)), "R008", "pitch range"),
    "yaw": (lambda ir: bent(ir, along(BODY_YAW, 9.0)), "R008", "yaw range"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", FAULTS)
def test_every_rule_is_broken_once_and_the_fault_names_the_shot(name: str) -> None:
    act, code, what = FAULTS[name]
    outcome = refine(returns(act), path_of=guide)
    assert outcome.value is None
    fault = outcome.diagnostics[0]
    assert fault.code == code
    assert what in " ".join((fault.message, *fault.notes))
    key = guide().keyframes.mission.origins.key(("shots", 0)).span
    assert key in [label.span for label in fault.labels]
    assert "refiner `odd` of package odd-maker" in fault.message


@pytest.mark.parametrize("name", FAULTS)
def test_a_shot_that_allows_it_flies_its_guide_and_the_other_stays_refined(name: str) -> None:
    act = FAULTS[name][0]
    outcome = refine(returns(lambda ir: act(bent(ir, along(Z, 0.1), AFTER))), True, path_of=guide)
    assert [d.code for d in outcome.diagnostics] == ["R003"]
    flown, before = outcome.value, guide(True)
    assert np.array_equal(leg(flown).curve.ctrl, leg(before).curve.ctrl)
    assert not np.array_equal(leg(flown, AFTER).curve.ctrl, leg(before, AFTER).curve.ctrl)


def test_a_sound_bend_is_taken_and_the_legs_around_stay() -> None:
    outcome = refine(returns(lambda ir: bent(ir, along(Z, 0.3))), path_of=guide)
    assert outcome.diagnostics == ()
    for old, new in zip(guide().timed[0].legs, outcome.value.timed[0].legs, strict=True):
        assert (old is new) == (old.shot != BY)
    outcome.value.check()


def test_legs_that_are_timed_already_are_not_a_refiner_s() -> None:
    outcome = refine(returns(transit_moved), path_of=guide)
    assert outcome.value is None
    assert outcome.diagnostics[0].code == "R005"
    assert "changed the transit" in outcome.diagnostics[0].message


def test_a_path_without_its_timed_legs_is_none() -> None:
    outcome = refine(returns(lambda ir: replace(ir, timed=())), path_of=guide)
    assert [d.code for d in outcome.diagnostics] == ["R002"]


def test_a_refiner_that_ignores_them_keeps_them() -> None:
    outcome = refine(returns(lambda ir: replace(ir, stats=(*ir.stats, ("mine", 1.0)))), path_of=guide)
    assert outcome.value.timed is guide().timed


@pytest.mark.long
def test_a_motion_that_breaks_a_limit_is_blamed_on_its_refiner(monkeypatch) -> None:
    odd = plugins.Source(Odd(lambda ir: Outcome(bent(ir, along(Z, 20.0)))), "odd-maker", "")
    monkeypatch.setattr(plugins, "one", lambda group, name: odd)
    options = api.PlanOptions(refiner="odd")
    done = api.compile_source(text().encode(), "run.yaml", None, options)
    assert [d.code for d in done.diagnostics] == ["R009"]
    kept = api.compile_source(text(optional=True).encode(), "run.yaml", None, options)
    assert kept.plan is not None
    assert [d.code for d in kept.diagnostics if d.code != "V034"] == ["R003", "R014"]


@pytest.mark.long
def test_a_deadline_s_process_hands_timed_legs_back() -> None:
    options = api.PlanOptions(refiner="ours", deadline=60.0)
    plain = api.PlanOptions(refiner="ours")
    a, b = (api.compile_source(text().encode(), "run.yaml", None, o).plan for o in (options, plain))
    assert a is not None
    assert b is not None
    assert np.array_equal(a.trajectory.drones[0].curve.ctrl, b.trajectory.drones[0].curve.ctrl)
