"""Comparison of the certificate in a plan file with the one that is proved now."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from math import inf, isclose

from shotc.ir.measures import distinct_measures
from shotc.ir.trajectory import Claim
from shotc.passes.verify.claims import LIMIT_TOLERANCE
from shotc.units import clip

_VERDICTS = {
    "holds": ("holds", "is broken"),
    "hard": ("is required", "is not required"),
    "upper": ("is bounded above", "is bounded below"),
}


def certificate_differences(
    written: Sequence[Claim], proved: Sequence[Claim], *, same_tool: bool
) -> Iterator[str]:
    """Yield the differences of a written certificate; another version of shotc may make other claims."""
    old, new = {c.key: c for c in written}, {c.key: c for c in proved}
    for key, times in Counter(c.key for c in written).items():
        if times > 1:
            yield f"{_name(old[key])} stands {times} times in the certificate"
    for key, claim in new.items():
        if key in old:
            yield from (f"{_name(claim)}: {text}" for text in _first_difference(old[key], claim))
        elif same_tool:
            yield f"{_name(claim)} is not in the certificate"
    if same_tool:
        for key, claim in old.items():
            if key not in new:
                yield f"{_name(claim)} is in the certificate, but follows from nothing in the plan"
        if old.keys() == new.keys() and list(old) != list(new):
            yield "the claims of the certificate are in another order"


def _name(claim: Claim) -> str:
    name = f"{clip(claim.subject)}: {clip(claim.constraint)}"
    return f"{name} of shot `{clip(claim.shot)}`" if claim.shot else name


def _first_difference(written: Claim, proved: Claim) -> Iterator[str]:
    """Yield the first field in which two claims of one name differ, if any."""
    if written.unit != proved.unit:
        yield f"it is in {_unit(written.unit)} by the certificate, in {_unit(proved.unit)} by the plan"
        return
    for field, name in (("limit", "limit"), ("worst", "worst value")):
        one, other = getattr(written, field), getattr(proved, field)
        if not _same(one, other):
            texts = distinct_measures(one, other, proved.unit)
            yield f"the {name} is {texts[0]} in the certificate, {texts[1]} in the plan"
            return
    for field, (yes, no) in _VERDICTS.items():
        one, other = getattr(written, field), getattr(proved, field)
        if one != other:
            yield f"it {yes if one else no} by the certificate, and {yes if other else no} by the plan"
            return
    yield from _other_words(written, proved)


def _other_words(written: Claim, proved: Claim) -> Iterator[str]:
    """Yield where two claims with equal values differ in time, place, method, key path or drones."""
    if not _same(_time(written), _time(proved)):
        yield f"it is worst {_when(written)} by the certificate, {_when(proved)} by the plan"
    elif (written.position is None) != (proved.position is None) or not all(
        map(_same, written.position or (), proved.position or ())
    ):
        yield "it is worst at another place by the certificate than by the plan"
    elif written.method != proved.method:
        yield f"it is {written.method} by the certificate, and {proved.method} by the plan"
    elif (written.path, written.drones) != (proved.path, proved.drones):
        yield "it is of another line or of other drones by the certificate than by the plan"


def _time(claim: Claim) -> float:
    return inf if claim.time is None else claim.time


def _when(claim: Claim) -> str:
    return "at no time" if claim.time is None else f"at t = {claim.time:.6f} s"


def _unit(unit: str) -> str:
    return f"`{clip(unit)}`" if unit else "no unit"


def _same(a: float, b: float) -> bool:
    return isclose(a, b, rel_tol=LIMIT_TOLERANCE, abs_tol=LIMIT_TOLERANCE)
