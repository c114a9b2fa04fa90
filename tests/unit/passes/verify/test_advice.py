"""How much longer a shot is to take for a value to fall to its limit."""

from __future__ import annotations

import pytest

from shotc.ir.phases import Phase
from shotc.passes.verify.advice import Rule, advice
from shotc.passes.verify.report import RULES, rule_of, state_of
from tests.support.film_plans import orbit_plan
from tests.support.records import replace

PHASE = Phase("shot", "look", 10.0, 30.0)


@pytest.mark.parametrize(
    ("power", "ratio", "seconds"),
    [(1.0, 1.5, "30.0"), (1 / 2, 4.0, "40.0"), (1 / 3, 8.0, "40.0"), (1.0, 1.0 + 1e-9, "20.1")],
)
def test_a_derivative_falls_by_a_power_of_the_time(power: float, ratio: float, seconds: str) -> None:
    plan = orbit_plan()
    speed = next(c for c in plan.certificate if c.constraint == "speed")
    broken = replace(speed, worst=ratio * speed.limit, holds=False)
    told = advice(plan.trajectory.keyframes.mission, broken, Rule("V001", power), PHASE)
    assert f"give shot `look` {float(seconds):g} s or more" in told.replace(".0 s", " s")
    assert "then plan again" in told


def test_what_no_time_helps_is_given_none() -> None:
    plan = orbit_plan()
    speed = next(c for c in plan.certificate if c.constraint == "speed")
    broken = replace(speed, worst=2.0 * speed.limit, holds=False)
    mission = plan.trajectory.keyframes.mission
    assert "give" not in advice(mission, broken, Rule("V005"), PHASE)
    assert "give" not in advice(mission, broken, Rule("V001", 1.0), None)
    assert advice(mission, broken, Rule("V015", help="as told"), PHASE) == "as told"


def test_every_rate_falls_with_the_time_and_every_higher_derivative_with_its_power() -> None:
    orders = {"speed": 1, "climb": 1, "descent": 1, "rate": 1, "acceleration": 2, "jerk": 3}
    mission = orbit_plan().trajectory.keyframes.mission
    found = {name: rule_of(name, mission).power for name in RULES if name.split()[-1] in orders}
    assert len(found) > 10
    assert found == {name: pytest.approx(1 / orders[name.split()[-1]]) for name in found}
    assert not any(rule.power for name, rule in RULES.items() if name not in found)


@pytest.mark.parametrize(
    ("constraint", "shot", "code", "told"),
    [
        ("zone mast", None, "V007", "the distance of the body from zone mast"),
        ("target tower", None, "V010", "the distance of the body from target tower"),
        ("zone field", None, "V008", "the margin of the body inside zone field"),
        ("distance from its path", "look", "V044", "distance from its path of shot `look`"),
        ("ground clearance", None, "V009", "ground clearance"),
    ],
)
def test_a_broken_claim_is_told_by_what_it_is_about(
    constraint: str, shot: str | None, code: str, told: str
) -> None:
    speed = next(c for c in orbit_plan().certificate if c.constraint == "speed")
    claim = replace(speed, constraint=constraint, shot=shot, worst=1.0, limit=2.0, unit="m", upper=False)
    assert state_of(claim, code) == f"{told} is 1.000 m, at least 2.000 m is needed"


@pytest.mark.parametrize(
    ("upper", "told"), [(True, "at most 2.000 m is allowed"), (False, "at least 2.000 m is needed")]
)
def test_a_limit_is_told_with_its_side(upper: bool, told: str) -> None:
    speed = next(c for c in orbit_plan().certificate if c.constraint == "speed")
    claim = replace(speed, worst=1.0, limit=2.0, unit="m", upper=upper)
    assert state_of(claim, "V001").endswith(told)


OWN = ("drones", "cam1")
SETTINGS = [
    ((*OWN, "limits", "speed"), "speed", True, "raise `limits.speed` to 9.433 m/s"),
    ((*OWN, "limits", "speed"), "speed", False, "lower `limits.speed` to 9.432 m/s"),
    ((*OWN, "gimbal", "yaw"), "gimbal yaw min", True, "raise the first value of `gimbal.yaw` to 9.433 m/s"),
    ((*OWN, "gimbal", "yaw"), "gimbal yaw max", True, "raise the second value of `gimbal.yaw` to 9.433 m/s"),
    (("rules", "look_ahead"), "look ahead", True, "raise `rules.look_ahead` to 9.433 m/s"),
    (("rules",), "look ahead", True, ""),
    ((*OWN, "home"), "distance from home", True, ""),
    (("limits", "speed", "more"), "speed", True, ""),
]


@pytest.mark.parametrize(("path", "constraint", "upper", "told"), SETTINGS)
def test_the_setting_of_a_limit_is_named_by_its_last_two_keys(
    path: tuple[str, ...], constraint: str, upper: bool, told: str
) -> None:
    plan = orbit_plan()
    speed = next(c for c in plan.certificate if c.constraint == "speed")
    broken = replace(speed, path=path, constraint=constraint, upper=upper, worst=9.4321, holds=False)
    found = advice(plan.trajectory.keyframes.mission, broken, Rule("V001"), None)
    assert found == (f"{told}, or plan the mission again" if told else "plan the mission again")
