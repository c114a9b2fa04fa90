"""A plan file proved again from its bytes alone, and its certificate held against the new proof."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite

from shotc import __version__
from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.base import PassContext
from shotc.passes.verify import judge
from shotc.passes.verify.claims import TOLERANCE
from shotc.passes.verify.report import measure
from shotc.planfile.read import read_plan
from shotc.source.file import WHOLE_FILE

REPORTED = 10
"""Differing claims that are reported one by one."""


@dataclass(frozen=True, slots=True)
class FileVerdict:
    """What became of a plan file.

    plan : the verified plan, or None where it breaks a hard claim or is no plan
    certificate : every claim as proved now, broken ones included
    mission : what the mission file was called, and the SHA-256 of its bytes, where the plan can be read
    """

    plan: VerifiedIR | None
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    mission: tuple[str, str] | None = None


def verify_file(data: bytes, name: str, ctx: PassContext) -> FileVerdict:
    """Prove the plan in ``data``; ``name`` is how to show the file."""
    read = read_plan(data, name)
    if read.trajectory is None:
        return FileVerdict(None, (), read.diagnostics)
    verdict = judge(read.trajectory, ctx)
    diagnostics = list(verdict.diagnostics)
    if verdict.certificate:
        same_tool = read.tool == __version__
        differing = list(_differences(read.certificate, verdict.certificate, same_tool=same_tool))
        label = (Label(name, WHOLE_FILE),)
        diagnostics += [
            Diagnostic("V040", text, label, help="plan the mission again") for text in differing[:REPORTED]
        ]
        if len(differing) > REPORTED:
            more = f"{len(differing) - REPORTED} more claims of the certificate differ"
            diagnostics.append(Diagnostic("V040", more, label))
    mission = read.trajectory.keyframes.mission
    return FileVerdict(
        None if has_errors(diagnostics) else VerifiedIR(read.trajectory, verdict.certificate),
        verdict.certificate,
        tuple(diagnostics),
        (mission.origins.file, mission.source_sha256),
    )


def _differences(written: tuple[Claim, ...], proved: tuple[Claim, ...], *, same_tool: bool) -> Iterator[str]:
    """Yield how the written certificate differs; another version of shotc may make other claims."""
    old, new = ({(c.subject, c.shot, c.constraint): c for c in claims} for claims in (written, proved))
    for key, claim in new.items():
        where = f"{claim.subject}: {claim.constraint}" + (f" of shot `{claim.shot}`" if claim.shot else "")
        if key not in old:
            if same_tool:
                yield f"{where} is not in the certificate"
        elif not _same(old[key].limit, claim.limit):
            yield f"the limit of {where} {_versus(old[key].limit, claim.limit, claim.unit)}"
        elif not _same(old[key].worst, claim.worst):
            yield f"{where} {_versus(old[key].worst, claim.worst, claim.unit)}"
        elif (old[key].holds, old[key].hard, old[key].upper) != (claim.holds, claim.hard, claim.upper):
            yield f"{where} is judged otherwise in the certificate"
    if same_tool:
        for subject, _, constraint in old.keys() - new.keys():
            yield f"{subject}: {constraint} is in the certificate, but follows from nothing in the plan"


def _same(a: float, b: float) -> bool:
    if not (isfinite(a) and isfinite(b)):
        return a == b
    return abs(a - b) <= TOLERANCE * max(1.0, abs(a), abs(b))


def _versus(written: float, proved: float, unit: str) -> str:
    return f"is {measure(written, unit)} in the certificate, {measure(proved, unit)} in the plan"
