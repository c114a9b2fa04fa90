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
from shotc.passes.verify.advice import REPLAN
from shotc.passes.verify.claims import TOLERANCE
from shotc.passes.verify.numbers import told_apart
from shotc.planfile.read import ReadPlan, read_plan
from shotc.source.file import WHOLE_FILE
from shotc.units import clip

REPORTED = 10
"""Differing claims that are reported one by one."""

NOTED = 3
"""Differing claims that are named where another version of shotc wrote the file."""

_VERDICTS = {
    "holds": ("holds", "is broken"),
    "hard": ("is required", "is not required"),
    "upper": ("is bounded above", "is bounded below"),
}


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
        diagnostics += _against_the_file(read, verdict.certificate, name)
    mission = read.trajectory.keyframes.mission
    return FileVerdict(
        None if has_errors(diagnostics) else VerifiedIR(read.trajectory, verdict.certificate),
        verdict.certificate,
        tuple(diagnostics),
        (mission.origins.file, mission.source_sha256),
    )


def _against_the_file(read: ReadPlan, proved: tuple[Claim, ...], name: str) -> list[Diagnostic]:
    """Report how the written certificate differs: claim by claim, or at once for another shotc's file."""
    same_tool = read.tool == __version__
    differing = list(_differences(read.certificate, proved, same_tool=same_tool))
    label = (Label(name, WHOLE_FILE),)
    if read.edited and not differing:
        text = "the mission in this plan is not the one it was planned for"
        note = "it was changed where no claim of the certificate shows it: the place on earth, a lens, a pad"
        return [Diagnostic("V040", text, label, (note,), REPLAN)]
    if differing and not same_tool:
        many = f"{len(differing)} claims of the certificate differ"
        writer = f"the file was written by shotc {clip(read.tool)}, this is {__version__}"
        notes = (writer, *differing[:NOTED])
        return [Diagnostic("V040", many, label, notes, "plan the mission again with this shotc")]
    found = [Diagnostic("V040", text, label, help=REPLAN) for text in differing[:REPORTED]]
    if len(differing) > REPORTED:
        more = f"{len(differing) - REPORTED} more claims of the certificate differ"
        found.append(Diagnostic("V040", more, label))
    return found


def _differences(written: tuple[Claim, ...], proved: tuple[Claim, ...], *, same_tool: bool) -> Iterator[str]:
    """Yield how the written certificate differs; another version of shotc may make other claims."""
    old, new = ({(c.subject, c.shot, c.constraint): c for c in claims} for claims in (written, proved))
    for key, claim in new.items():
        where = f"{claim.subject}: {claim.constraint}" + (f" of shot `{claim.shot}`" if claim.shot else "")
        if key in old:
            yield from (f"{where}: {text}" for text in _first_difference(old[key], claim))
        elif same_tool:
            yield f"{where} is not in the certificate"
    if same_tool:
        for subject, _, constraint in old.keys() - new.keys():
            yield f"{subject}: {constraint} is in the certificate, but follows from nothing in the plan"


def _first_difference(written: Claim, proved: Claim) -> Iterator[str]:
    """Yield the first field in which two claims of one name differ, if any."""
    for field, name in (("limit", "limit"), ("worst", "worst value")):
        one, other = getattr(written, field), getattr(proved, field)
        if not _same(one, other):
            shown = told_apart(one, other, proved.unit)
            yield f"the {name} is {shown[0]} in the certificate, {shown[1]} in the plan"
            return
    for field, (yes, no) in _VERDICTS.items():
        one, other = getattr(written, field), getattr(proved, field)
        if one != other:
            yield f"it {yes if one else no} by the certificate, and {yes if other else no} by the plan"
            return


def _same(a: float, b: float) -> bool:
    if not (isfinite(a) and isfinite(b)):
        return a == b
    return abs(a - b) <= TOLERANCE * max(1.0, abs(a), abs(b))
