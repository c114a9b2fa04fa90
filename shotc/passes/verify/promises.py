"""Broken promises of a shot: what is seen of the target, and which promise this plan would keep."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from shotc.diag.model import Diagnostic
from shotc.ir.measures import SHARES, distinct_measures, enough
from shotc.ir.mission import Shot
from shotc.ir.owners import owner_of
from shotc.ir.path import CORNERS
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.visible import AT_FIRST, AT_LAST, VISIBLE
from shotc.rounding import at_least, rounded_outward

OUTLINES = frozenset({"V028", "V029"})
"""Codes of broken promises on the visible share of a target."""

PROMISES = frozenset({"V019", "V020", "V021"}) | OUTLINES
"""Codes of broken promises."""

FARTHEST_HALF_FRAMES = 3.0
"""Largest screen error that can be promised, half frames."""

SMALLEST_SHARE = 0.01
"""Smallest share of frames or of an outline that can be promised; a smaller promise says nothing."""

_ERROR_DIGITS = 3
_INSTEAD = {
    "V019": "film from farther away or through a wider lens where the target is cropped",
    "V020": "turn the camera less there",
    "V021": "change the distance or the field of view there",
    "V028": "film from another side or from higher up there",
    "V029": "begin or end the shot elsewhere",
}
_ENDS = {"V019": " in frame", "V020": " screen error", "V021": " size ", "V028": VISIBLE, "V029": VISIBLE}
_KEYS = {"in_frame": "V019", "screen_error": "V020", "size": "V021", "visible": "V028", "reveal": "V029"}
_UNSEEN = {
    "V020": "its place on screen is unknown: the target is behind the camera",
    "V021": "its size is unknown: a part of the target is not before the camera",
}


def broken_promise(claim: Claim, code: str) -> str:
    """Return the message on a broken promise: what is seen of the target, and what was promised."""
    target = target_of(claim, code)
    shot = f"shot `{claim.shot}`"
    if not isfinite(claim.worst):
        return f"{target} in {shot}: {_UNSEEN[code]}"
    reached, promised = distinct_measures(
        claim.worst, claim.limit, claim.unit if claim.unit in SHARES else ""
    )
    if code == "V019":
        return f"{target} is whole in {reached} of the frames of {shot}, {promised} is promised"
    side = "most" if claim.upper else "least"
    if code in OUTLINES:
        frame = "the last" if claim.constraint.endswith(AT_LAST) else "the first"
        frame = "a" if code == "V028" else frame
        free = f"{reached} of the outline of {target} is free in {frame} frame of {shot}"
        return f"{free}, {promised} is promised at {side}"
    if code == "V020":
        return (
            f"{target} is {reached} of half a frame off its place on screen in {shot}, "
            f"{promised} is promised at {side}"
        )
    return f"{target} fills {reached} of the frame's height in {shot}, {promised} is promised at {side}"


def target_of(claim: Claim, code: str) -> str:
    """Return the name of the target of a claim on a promise."""
    return claim.constraint.rpartition(_ENDS[code])[0]


def promise_help(claim: Claim, code: str, shot: Shot, certificate: tuple[Claim, ...]) -> str:
    """Return the promise to write instead, if there is one, and another remedy."""
    promise = _kept_promise(claim, code, shot, certificate) if isfinite(claim.worst) else ""
    return f"promise `{promise}`, or {_INSTEAD[code]}" if promise else _INSTEAD[code]


def unjudged(ir: TrajectoryIR, certificate: tuple[Claim, ...]) -> Iterator[Diagnostic]:
    """Yield an error for every promise of a flown shot without a claim in the certificate."""
    origins = ir.keyframes.mission.origins
    flown = {p.shot for track in ir.drones for p in track.phases}
    for shot in (s for s in ir.keyframes.mission.shots if s.id in flown):
        names = [claim.constraint for claim in certificate if claim.shot == shot.id]
        for key, code in _KEYS.items():
            if getattr(shot.promise, key) is None or any(_ENDS[code] in name for name in names):
                continue
            yield Diagnostic(
                "V046",
                f"shot `{shot.id}` promises `{key}`, but nothing in the plan can be judged by it",
                (origins.value((*shot.path, "require", key)),),
                ("no target of the shot is framed, or none has a place on screen",),
                f"remove `{key}`, or give the shot a target and a composition; then plan the mission again",
            )


def bends(ir: TrajectoryIR, shot: str) -> Iterator[str]:
    """Yield how far and why a shot's path leaves the one that its kind generates."""
    for deviation in ir.deviations:
        if deviation.shot == shot and deviation.cause != CORNERS:
            owner = owner_of(ir.keyframes.mission, deviation.cause)
            cause = deviation.cause if owner is None else owner.words
            yield f"the shot leaves its ideal path by up to {at_least(deviation.distance)} m, round {cause}"


def _kept_promise(claim: Claim, code: str, shot: Shot, certificate: tuple[Claim, ...]) -> str:
    """Return the promise that holds, as YAML; empty where there is none worth a line."""
    if code in {"V019", "V028"} and claim.worst < SMALLEST_SHARE:
        return ""
    if code == "V019":
        return f"in_frame: {enough(claim)}"
    if code == "V021":
        return _size(shot, certificate)
    if code == "V028":
        return f"visible: {enough(claim)}"
    if code == "V029":
        return _reveal(shot, certificate)
    error = rounded_outward(claim.worst, upper=True, digits=_ERROR_DIGITS)
    return f"screen_error: {error:.{_ERROR_DIGITS}g}" if error <= FARTHEST_HALF_FRAMES else ""


def _size(shot: Shot, certificate: tuple[Claim, ...]) -> str:
    """Return the range of sizes that all targets of the shot keep; empty where there is none."""
    assert shot.promise.size is not None
    low, high = shot.promise.size
    broken = [c for c in certificate if c.shot == shot.id and not c.holds and _ENDS["V021"] in c.constraint]
    if not all(isfinite(c.worst) for c in broken):
        return ""
    low = min(
        [low, *(rounded_outward(c.worst, upper=False, digits=_ERROR_DIGITS) for c in broken if not c.upper)]
    )
    high = max(
        [high, *(rounded_outward(c.worst, upper=True, digits=_ERROR_DIGITS) for c in broken if c.upper)]
    )
    return f"size: [{low:g}, {high:g}]" if high <= 1 else ""


def _reveal(shot: Shot, certificate: tuple[Claim, ...]) -> str:
    """Return the reveal that all targets of the shot keep; empty where its direction would change."""
    assert shot.promise.reveal is not None
    shares = []
    for promised, end in zip(shot.promise.reveal, (AT_FIRST, AT_LAST), strict=True):
        broken = [c for c in certificate if c.shot == shot.id and not c.holds and c.constraint.endswith(end)]
        worst = [rounded_outward(c.worst, upper=c.upper, digits=_ERROR_DIGITS) for c in broken]
        shares.append((max if broken[0].upper else min)(worst) if broken else promised)
    (first, last), (start, finish) = shot.promise.reveal, shares
    if (finish - start) * (last - first) <= 0:
        return ""
    return f"reveal: {{from: {100 * start:.{_ERROR_DIGITS}g} %, to: {100 * finish:.{_ERROR_DIGITS}g} %}}"
