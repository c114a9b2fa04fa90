"""A certificate as a table: what was asked, the worst that happens, when, and how that is known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isfinite

from shotc.cli.table import clock, table
from shotc.ir.measures import measure, told_apart
from shotc.ir.trajectory import Claim
from shotc.passes.verify.sight import OUT_OF_PICTURE

WAYS = {"bounded": "every instant", "exact": "arithmetic", "sampled": "output samples"}
HEADING = ("", "claim", "asked", "worst", "at", "known by")


def certificate_text(certificate: Sequence[Claim]) -> str:
    """Return one table for every drone's flight and for each of its shots."""
    parts: list[str] = []
    for subject, shot in dict.fromkeys((c.subject, c.shot) for c in certificate):
        claims = [c for c in certificate if (c.subject, c.shot) == (subject, shot)]
        parts.append(f"{subject}, " + ("whole flight" if shot is None else f"shot {shot}"))
        parts += ["  " + line for line in table([HEADING, *_rows(claims)])]
        parts.append("")
    return "\n".join(parts[:-1])


def _rows(claims: Sequence[Claim]) -> Iterator[tuple[str, ...]]:
    for claim in claims:
        yield (
            mark(claim),
            *_values(claim),
            "" if claim.time is None else clock(claim.time),
            WAYS[claim.method] + (f", {' and '.join(claim.drones)}" if claim.drones else ""),
        )


def _values(claim: Claim) -> tuple[str, str, str]:
    """Return what a claim is about, what is asked, and the worst that happens."""
    if claim.constraint.endswith(OUT_OF_PICTURE) and claim.unit == "m" and isfinite(claim.worst):
        side = "outside" if claim.worst >= 0.0 else "inside"
        return claim.constraint, "outside the frame", f"{measure(abs(claim.worst), 'm')} {side}"
    worst, limit = measure(claim.worst, claim.unit), measure(claim.limit, claim.unit)
    if not claim.holds:
        worst, limit = told_apart(claim.worst, claim.limit, claim.unit)
    asked = f"{'<=' if claim.upper else '>='} {limit}" if isfinite(claim.limit) else "-"
    return claim.constraint, asked, worst if isfinite(claim.worst) else "-"


def mark(claim: Claim) -> str:
    """Return a word for what has become of a claim."""
    if not claim.holds:
        return "BROKEN" if claim.hard else "lost"
    return "ok" if isfinite(claim.limit) else ""
