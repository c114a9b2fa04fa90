"""What of a written certificate differs from the one that is proved: every field, and nothing else."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from shotc.ir.trajectory import Claim
from shotc.passes.verify.certificate import certificate_differences
from tests.support.film_plans import SPEED
from tests.support.records import replace

CLIMB: Claim = replace(SPEED, constraint="climb", shot="half")
BOTH = (SPEED, CLIMB)


def said(written: Sequence[Claim], proved: Sequence[Claim], *, same_tool: bool = True) -> list[str]:
    return list(certificate_differences(written, proved, same_tool=same_tool))


@pytest.mark.parametrize("same_tool", [True, False])
def test_the_same_claims_do_not_differ(same_tool: bool) -> None:
    assert said(BOTH, BOTH, same_tool=same_tool) == []
    assert said((), (), same_tool=same_tool) == []


FIELDS = {
    "limit": (8.5, "the limit is 8.5 m/s in the certificate, 8 m/s in the plan"),
    "worst": (7.5, "the worst value is 7.5 m/s in the certificate, 7.9 m/s in the plan"),
    "unit": ("m", "it is in `m` by the certificate, in `m/s` by the plan"),
    "holds": (False, "it is broken by the certificate, and holds by the plan"),
    "hard": (False, "it is not required by the certificate, and is required by the plan"),
    "upper": (False, "it is bounded below by the certificate, and is bounded above by the plan"),
    "time": (36.0, "it is worst at t = 36.000000 s by the certificate, at t = 37.000000 s by the plan"),
    "position": ((40.0, 1.0, 20.0), "it is worst at another place by the certificate than by the plan"),
    "method": ("sampled", "it is sampled by the certificate, and bounded by the plan"),
    "path": (("rules",), "it is of another line or of other drones by the certificate than by the plan"),
    "drones": (("one",), "it is of another line or of other drones by the certificate than by the plan"),
}


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("same_tool", [True, False])
def test_every_field_counts(field: str, same_tool: bool) -> None:
    value, text = FIELDS[field]
    other = (replace(SPEED, **{field: value}), CLIMB)
    assert said(other, BOTH, same_tool=same_tool) == [f"cam1: speed: {text}"]


@pytest.mark.parametrize("field", ["time", "position"])
def test_a_time_or_a_place_that_is_left_out_counts(field: str) -> None:
    without = (replace(SPEED, **{field: None}), CLIMB)
    assert len(said(without, BOTH)) == len(said(BOTH, without)) == 1
    assert said(without, without) == []
    never = "it is worst at no time by the certificate, at t = 37.000000 s by the plan"
    if field == "time":
        assert said(without, BOTH) == [f"cam1: speed: {never}"]


def test_no_unit_is_said_so() -> None:
    bare: Claim = replace(SPEED, unit="")
    assert said([bare], [SPEED]) == ["cam1: speed: it is in no unit by the certificate, in `m/s` by the plan"]


@pytest.mark.parametrize(("share", "count"), [(0.9e-6, 0), (1.1e-6, 1)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("field", ["limit", "worst", "time"])
def test_numbers_differ_from_a_millionth_on(field: str, sign: float, share: float, count: int) -> None:
    # The larger of the two numbers is the measure, so the share is of eight, or of a little more.
    near: Claim = replace(SPEED, limit=8.0, worst=8.0, time=8.0)
    other: Claim = replace(near, **{field: 8.0 * (1.0 + sign * share)})
    assert len(said([other], [near])) == count


@pytest.mark.parametrize(("metres", "count"), [(0.9e-6, 0), (1.1e-6, 1)])
@pytest.mark.parametrize("axis", range(3))
def test_places_differ_from_a_micrometre_on(axis: int, metres: float, count: int) -> None:
    near: Claim = replace(SPEED, position=(0.0, 0.0, 0.0))
    place = [0.0, 0.0, 0.0]
    place[axis] = metres
    assert len(said([replace(SPEED, position=tuple(place))], [near])) == count


def test_a_claim_that_lacks_counts_for_the_same_shotc() -> None:
    assert said([SPEED], BOTH) == ["cam1: climb of shot `half` is not in the certificate"]
    assert said([SPEED], BOTH, same_tool=False) == []


def test_a_claim_of_nothing_counts_for_the_same_shotc() -> None:
    text = "cam1: climb of shot `half` is in the certificate, but follows from nothing in the plan"
    assert said(BOTH, [SPEED]) == [text]
    assert said(BOTH, [SPEED], same_tool=False) == []


def test_a_claim_that_stands_twice_counts_for_every_shotc() -> None:
    twice = [*BOTH, SPEED]
    assert said(twice, BOTH) == ["cam1: speed stands 2 times in the certificate"]
    assert said(twice, BOTH, same_tool=False) == ["cam1: speed stands 2 times in the certificate"]
    assert said([*twice, SPEED], BOTH) == ["cam1: speed stands 3 times in the certificate"]


def test_the_order_counts_for_the_same_shotc() -> None:
    assert said(BOTH[::-1], BOTH) == ["the claims of the certificate are in another order"]
    assert said(BOTH[::-1], BOTH, same_tool=False) == []


@pytest.mark.parametrize("field", ["subject", "shot", "constraint"])
def test_claims_are_told_apart_by_whom_what_and_when(field: str) -> None:
    other: Claim = replace(SPEED, **{field: "other"})
    assert said([SPEED, other], [SPEED, other]) == []
    assert len(said([SPEED], [other])) == 2
