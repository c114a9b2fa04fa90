"""``shotc verify``: prove a plan again from its file alone."""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated

import typer

from shotc.api import MissionFile, PlanReport
from shotc.cli import console
from shotc.cli.inputs import read_mission
from shotc.cli.plans import PlanPath, prove
from shotc.diag.render.json import render


class Format(StrEnum):
    """How the certificate is printed."""

    TEXT = "text"
    JSON = "json"


FormatOption = Annotated[Format, typer.Option("--format", help="How to print the certificate.")]


AgainstOption = Annotated[
    str | None, typer.Option("--against", metavar="MISSION", help="Hold the plan to this mission file, too.")
]


def verify(plan: PlanPath, format: FormatOption = Format.TEXT, against: AgainstOption = None) -> None:
    """Prove a plan again, trusting nothing but its trajectory and the text of its mission.

    Prints the certificate: for every claim what was asked, the worst that happens, when, and how that is
    known. The exit status is 1 if a claim is broken, if the plan says something else than its mission or its
    proof, or with --against if it is not the plan of that file.

    Example: shotc verify out/tower/plan.json --against tower.yaml
    """
    report = prove(plan, None if against is None else MissionFile(*read_mission(against)))
    if format is Format.JSON:
        console.out(_document(report))
    else:
        _print(report)
    raise typer.Exit(console.exit_code(report.diagnostics))


def _print(report: PlanReport) -> None:
    from shotc.cli.summary import certificate_text

    if report.certificate:
        console.out(certificate_text(report.certificate))
    console.report(report.diagnostics, report.sources)
    if report.plan is not None:
        hard = sum(claim.hard for claim in report.certificate)
        console.note(f"the plan holds: {hard} requirements proved again")


def _document(report: PlanReport) -> str:
    from shotc.planfile.codec import encode

    document = json.loads(render(report.diagnostics, report.sources))
    found = {"holds": report.plan is not None, "certificate": encode(report.certificate)}
    return json.dumps(found | document, indent=2)
