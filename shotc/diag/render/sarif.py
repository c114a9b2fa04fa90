"""Render diagnostics as SARIF 2.1.0, in the subset that GitHub code scanning reads."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any
from urllib.parse import quote

from shotc import __version__
from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Diagnostic, Label
from shotc.diag.render.common import info_of, ordered
from shotc.source.file import SourceFile

_MAX_RESULTS = 25_000
"""Most results that GitHub accepts in one run."""


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile]) -> str:
    """Return a SARIF log with one run and the rules that its results name.

    A diagnostic without a place becomes a notification of the run: GitHub refuses results without locations.
    """
    reported = ordered(diagnostics)[:_MAX_RESULTS]
    placed = [d for d in reported if d.labels]
    unplaced = [d for d in reported if not d.labels]
    rules = {d.code: info_of(d) for d in reported}
    index = {code: number for number, code in enumerate(sorted(rules))}
    run = {
        "tool": {
            "driver": {
                "name": "shotc",
                "semanticVersion": __version__,
                "rules": [_rule(rules[code]) for code in index],
            }
        },
        "invocations": [
            {
                "executionSuccessful": True,
                "toolConfigurationNotifications": [_notification(d, index) for d in unplaced],
            }
        ],
        "columnKind": "unicodeCodePoints",
        "results": _results(placed, index, sources),
    }
    log = {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [run]}
    return json.dumps(log, indent=2) + "\n"


def _rule(info: CodeInfo) -> dict[str, Any]:
    return {
        "id": info.code,
        "name": "".join(part.capitalize() for part in info.slug.split("-")),
        "shortDescription": {"text": info.summary},
        "fullDescription": {"text": info.explanation},
        "help": {"text": info.explanation, "markdown": f"{info.explanation}\n\n`shotc explain {info.code}`"},
        "defaultConfiguration": {"level": info.severity.value},
    }


def _results(
    diagnostics: Sequence[Diagnostic], index: Mapping[str, int], sources: Mapping[str, SourceFile]
) -> list[dict[str, Any]]:
    seen: dict[str, int] = {}
    results = []
    for diagnostic in diagnostics:
        fingerprint = _fingerprint(diagnostic, sources)
        occurrence = seen[fingerprint] = seen.get(fingerprint, 0) + 1
        results.append(
            {
                "ruleId": diagnostic.code,
                "ruleIndex": index[diagnostic.code],
                "level": info_of(diagnostic).severity.value,
                "message": {"text": _text(diagnostic)},
                "locations": [_location(label) for label in diagnostic.labels[:1]],
                "relatedLocations": [
                    {"id": number, **_location(label)}
                    for number, label in enumerate(diagnostic.labels[1:], 1)
                ],
                "partialFingerprints": {"primaryLocationLineHash": f"{fingerprint}:{occurrence}"},
            }
        )
    return results


def _notification(diagnostic: Diagnostic, index: Mapping[str, int]) -> dict[str, Any]:
    return {
        "descriptor": {"id": diagnostic.code, "index": index[diagnostic.code]},
        "level": info_of(diagnostic).severity.value,
        "message": {"text": _text(diagnostic)},
    }


def _text(diagnostic: Diagnostic) -> str:
    parts = [diagnostic.message, *diagnostic.notes]
    if diagnostic.help:
        parts.append(f"help: {diagnostic.help}")
    return "\n".join(parts)


def _location(label: Label) -> dict[str, Any]:
    """Return the location of a label. SARIF counts from 1 with exclusive ends, as shotc does."""
    span = label.span
    region = {"startLine": max(1, span.line), "startColumn": max(1, span.column)}
    if (span.end_line, span.end_column) > (span.line, span.column):
        region |= {"endLine": span.end_line, "endColumn": span.end_column}
    location: dict[str, Any] = {
        "physicalLocation": {"artifactLocation": {"uri": _uri(label.file)}, "region": region}
    }
    if label.text:
        location["message"] = {"text": label.text}
    return location


def _uri(name: str) -> str:
    # A name that is not UTF-8 holds surrogates. Percent-encoding covers its bytes like any others.
    plain = name.replace("\\", "/").removeprefix("./").encode("utf-8", "surrogatepass")
    return quote(plain, safe="/-._~")


def _fingerprint(diagnostic: Diagnostic, sources: Mapping[str, SourceFile]) -> str:
    """Hash the code, file, text of the line and message: they stay the same if lines above are added."""
    line = name = ""
    if diagnostic.labels:
        first = diagnostic.labels[0]
        name = first.file
        line = " ".join(sources[name].line(first.span.line).split()) if name in sources else ""
    content = "\0".join((diagnostic.code, name, line, diagnostic.message))
    return sha256(content.encode("utf-8", "backslashreplace")).hexdigest()[:16]
