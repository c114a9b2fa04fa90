"""Verification of a plan file from its bytes alone, and comparison of its certificate with the new proof."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shotc import __version__
from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import has_errors
from shotc.geom.surface.tree import Surface
from shotc.ir.keyframes import KeyframeIR, Lowered
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.ir.source import MissionSource
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.verify import judge
from shotc.passes.verify.advice import REPLAN
from shotc.passes.verify.asked import MissionDifference, differences, source_differences
from shotc.passes.verify.certificate import certificate_differences
from shotc.planfile.read import ReadPlan, read_plan
from shotc.source.file import WHOLE_FILE, SourceFile
from shotc.units import clip

Lower = Callable[[MissionSource, str], Lowered]

Digests = tuple[tuple[str, str], ...]
"""Names of files, and their SHA-256."""

MOST_REPORTED = 10
"""Most differing claims that are reported separately."""

MOST_NOTED = 3
"""Most differing claims that are named if another version of shotc wrote the file."""


@dataclass(frozen=True, slots=True)
class FileVerdict:
    """The result for a plan file.

    plan : the verified plan; None where it breaks a hard claim or is no plan
    certificate : every claim as proved now, broken ones included
    mission : text of the mission in the plan, where the plan can be read
    written : the plan's data of its mission, then
    lowered : the mission lowered again, with its terrain and meshes, where that is possible
    """

    plan: VerifiedIR | None
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    mission: SourceFile | None = None
    written: KeyframeIR | None = None
    lowered: KeyframeIR | None = None


def verify_file(data: bytes, name: str, ctx: PassContext, lower: Lower) -> FileVerdict:
    """Return the proof of the plan in ``data`` against its mission, which is lowered again.

    name : of the file in messages
    lower : lowers the mission that a plan contains
    """
    read = read_plan(data, name)
    if read.trajectory is None:
        return FileVerdict(None, (), read.diagnostics)
    written = read.trajectory.keyframes
    lowered = lower(written.mission.source, written.mission.origins.file)
    if lowered.keyframes is None:
        return FileVerdict(None, (), _not_lowered(read, lowered, name), lowered.file, written)
    other = _of_another_mission(read, lowered.keyframes)
    # A plan of another mission is judged by its own data: its faults may explain the change.
    ir = read.trajectory if other else replace(read.trajectory, keyframes=lowered.keyframes)
    verdict = judge(ir, ctx)
    diagnostics = [*other, *verdict.diagnostics]
    if verdict.certificate:
        diagnostics += _against_the_file(read, verdict.certificate, name)
    verified = VerifiedIR(ir, verdict.certificate, verdict.covered)
    plan = None if has_errors(diagnostics) else verified
    return FileVerdict(
        plan, verdict.certificate, tuple(diagnostics), lowered.file, written, lowered.keyframes
    )


def against(written: KeyframeIR, lowered: KeyframeIR | None, reviewed: Lowered) -> list[Diagnostic]:
    """Return the differences between a plan and a mission that was lowered from a separate file.

    written, lowered : as of ``FileVerdict``
    """
    if reviewed.keyframes is None:
        text = "this mission cannot be lowered, so no plan can be held to it"
        fault = Diagnostic(
            "V043", text, (Label(reviewed.file.name, WHOLE_FILE),), help="correct its faults first"
        )
        return [fault, *reviewed.diagnostics]
    source, now = written.mission.source, reviewed.keyframes.mission.source
    diagnostics = [
        *differences(written, reviewed.keyframes, same_text=False),
        *(
            MissionDifference((), f"`{name}` is another file than the plan draws")
            for name in _changed(source.drawn, now.drawn)
        ),
        *(
            MissionDifference((), f"`{name}` is another file than the plan was made with")
            for name in _changed(source.linked, now.linked)
        ),
        *([] if lowered is None else _other_world(lowered.mission, reviewed.keyframes.mission)),
    ]
    return diagnostics_of(diagnostics, reviewed.keyframes, "V043", ())


def _other_world(mine: MissionIR, true: MissionIR) -> Iterator[MissionDifference]:
    """Yield the terrain, the scene and the buildings that are others than those that a plan was made with."""
    ground = [None if m.terrain is None else m.terrain.ground.surface for m in (mine, true)]
    if not _alike(*ground):
        yield MissionDifference(("world", "terrain"), "the terrain is another than the plan was made with")
    for kind in ("scene", "buildings"):
        meshes = (next((mesh.surface for mesh in m.meshes if mesh.kind == kind), None) for m in (mine, true))
        if not _alike(*meshes):
            words = f"the {kind} {'is' if kind == 'scene' else 'are'}"
            yield MissionDifference(("world", kind), f"{words} another than the plan was made with")


def _alike(one: Surface | None, other: Surface | None) -> bool:
    """Tell whether two surfaces are of the same triangles, or there are none."""
    if one is None or other is None:
        return one is other
    return np.array_equal(one.triangles, other.triangles)


def _changed(mine: Digests, true: Digests) -> list[str]:
    """Return the files whose digests differ."""
    before = dict(mine)
    return [name for name, digest in true if before.get(name, digest) != digest]


def _not_lowered(read: ReadPlan, lowered: Lowered, name: str) -> tuple[Diagnostic, ...]:
    """Return why the mission in a plan cannot be lowered, followed by its own faults."""
    label = (Label(name, WHOLE_FILE),)
    assert read.trajectory is not None
    if not read.trajectory.keyframes.mission.source.text:
        text = "the plan does not hold the mission that it was made from"
        return (Diagnostic("V042", text, label, _writer(read), REPLAN),)
    text = "the mission in the plan cannot be lowered, so the requirements on the plan are unknown"
    notes = ("the faults of that mission follow", *_writer(read))
    help_ = f"{REPLAN}; where a kind of shot is unknown, install the package that it comes from"
    return (Diagnostic("V042", text, label, notes, help_), *lowered.diagnostics)


def _writer(read: ReadPlan) -> tuple[str, ...]:
    if read.tool == __version__:
        return ()
    return (f"the file was written by shotc {clip(read.tool)}, this is {__version__}",)


def _of_another_mission(read: ReadPlan, reviewed: KeyframeIR) -> list[Diagnostic]:
    """Return the differences between the plan's data of its mission and the mission."""
    assert read.trajectory is not None
    written = read.trajectory.keyframes
    differing = [*differences(written, reviewed), *source_differences(written.mission, reviewed.mission)]
    return diagnostics_of(differing, reviewed, "V041", (*_writer(read),))


def diagnostics_of(
    differing: Sequence[MissionDifference], reviewed: KeyframeIR, code: str, notes: tuple[str, ...]
) -> list[Diagnostic]:
    """Return differences as diagnostics on the mission's lines: the first ones each, the others together."""
    diagnostics = [
        Diagnostic(code, d.text, (reviewed.mission.origins.value(d.path),), notes, REPLAN)
        for d in differing[:MOST_REPORTED]
    ]
    if len(differing) > MOST_REPORTED:
        more = f"and {len(differing) - MOST_REPORTED} more differences between the plan and its mission"
        diagnostics.append(Diagnostic(code, more, (reviewed.mission.origins.value(()),), help=REPLAN))
    return diagnostics


def _against_the_file(read: ReadPlan, proved: tuple[Claim, ...], name: str) -> list[Diagnostic]:
    """Return how the written certificate differs, claim by claim; for another shotc as one diagnostic."""
    same_tool = read.tool == __version__
    differing = list(certificate_differences(read.certificate, proved, same_tool=same_tool))
    label = (Label(name, WHOLE_FILE),)
    if read.edited and not differing:
        text = "the mission in this plan is not the one it was planned for"
        note = "it was changed where no claim of the certificate shows it: the place on earth, a lens, a pad"
        return [Diagnostic("V040", text, label, (note,), REPLAN)]
    if differing and not same_tool:
        many = f"{len(differing)} claims of the certificate differ"
        writer = f"the file was written by shotc {clip(read.tool)}, this is {__version__}"
        notes = (writer, *differing[:MOST_NOTED])
        return [Diagnostic("V040", many, label, notes, "plan the mission again with this shotc")]
    diagnostics = [Diagnostic("V040", text, label, help=REPLAN) for text in differing[:MOST_REPORTED]]
    if len(differing) > MOST_REPORTED:
        more = f"{len(differing) - MOST_REPORTED} more claims of the certificate differ"
        diagnostics.append(Diagnostic("V040", more, label))
    return diagnostics
