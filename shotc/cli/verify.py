"""``shotc verify``: prove a plan again from its file alone."""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated

import typer

from shotc.api import PlanReport
from shotc.cli import console
from shotc.cli.plans import PlanPath, prove


class Format(StrEnum):
    """How the certificate is printed."""

    TEXT = "text"
    JSON = "json"


FormatOption = Annotated[Format, typer.Option("--format", help="How to print the certificate.")]


def verify(plan: PlanPath, format: FormatOption = Format.TEXT) -> None:
    """Prove a plan again, trusting nothing but its trajectory and its limits.

    Prints the certificate: for every claim what was asked, the worst that happens, when, and how that is
    known. The exit status is 1 if a claim is broken, or if the file's own certificate says something else.

    Example: shotc verify out/tower/plan.json
    """
    report = prove(plan)
    if format is Format.JSON:
        console.out(_document(report))
    else:
        _print(report)
    raise typer.Exit(console.exit_code(report.diagnostics))


def _print(report: PlanReport) -> None:
    from shotc.cli.certificate import certificate_text

    if report.certificate:
        console.out(certificate_text(report.certificate))
    console.report(report.diagnostics, report.sources)
    if report.plan is not None:
        hard = sum(claim.hard for claim in report.certificate)
        console.note(f"the plan holds: {hard} requirements proved again")


def _document(report: PlanReport) -> str:
    from shotc.diag.render.json import render
    from shotc.planfile.codec import encode

    document = json.loads(render(report.diagnostics, report.sources))
    found = {"holds": report.plan is not None, "certificate": encode(report.certificate)}
    return json.dumps(found | document, indent=2)
