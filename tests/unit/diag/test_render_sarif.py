"""SARIF: the shape that GitHub reads, places that agree with the source, fingerprints that last."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest

from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry
from shotc.diag.render.sarif import render
from shotc.source.file import SourceFile, Span
from tests.support.diagnostics import MISSION, REPORT, SOURCES, at
from tests.support.records import replace

TEXT = {"type": "object", "required": ["text"], "properties": {"text": {"type": "string", "minLength": 1}}}
REGION = {
    "type": "object",
    "required": ["startLine", "startColumn"],
    "additionalProperties": False,
    "properties": {
        n: {"type": "integer", "minimum": 1} for n in ("startLine", "startColumn", "endLine", "endColumn")
    },
}
LOCATION = {
    "type": "object",
    "required": ["physicalLocation"],
    "additionalProperties": False,
    "properties": {
        "id": {"type": "integer", "minimum": 0},
        "message": TEXT,
        "physicalLocation": {
            "type": "object",
            "required": ["artifactLocation", "region"],
            "properties": {
                "artifactLocation": {
                    "type": "object",
                    "required": ["uri"],
                    "properties": {"uri": {"type": "string", "pattern": "^[A-Za-z0-9._~/%-]+$"}},
                },
                "region": REGION,
            },
        },
    },
}
LEVEL = {"enum": ["none", "note", "warning", "error"]}
# The part of the SARIF 2.1.0 schema that we write, with what GitHub asks on top of it.
SCHEMA = {
    "type": "object",
    "required": ["$schema", "version", "runs"],
    "properties": {
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "minItems": 1,
            "maxItems": 20,
            "items": {
                "type": "object",
                "required": ["tool", "results", "columnKind"],
                "properties": {
                    "columnKind": {"const": "unicodeCodePoints"},
                    "tool": {
                        "type": "object",
                        "required": ["driver"],
                        "properties": {
                            "driver": {
                                "type": "object",
                                "required": ["name", "rules", "semanticVersion"],
                                "properties": {
                                    "rules": {
                                        "type": "array",
                                        "uniqueItems": True,
                                        "items": {
                                            "type": "object",
                                            "required": ["id", "shortDescription", "fullDescription", "help"],
                                            "properties": {
                                                "id": {"pattern": "^[A-Z][0-9]{3}$"},
                                                "name": {"pattern": "^[A-Za-z0-9]+$"},
                                                "shortDescription": TEXT,
                                                "fullDescription": TEXT,
                                                "help": TEXT,
                                            },
                                        },
                                    }
                                },
                            }
                        },
                    },
                    "results": {
                        "type": "array",
                        "maxItems": 25_000,
                        "items": {
                            "type": "object",
                            "required": [
                                "ruleId",
                                "ruleIndex",
                                "level",
                                "message",
                                "locations",
                                "partialFingerprints",
                            ],
                            "properties": {
                                "level": LEVEL,
                                "message": TEXT,
                                "locations": {
                                    "type": "array",
                                    "minItems": 1,
                                    "maxItems": 1,
                                    "items": LOCATION,
                                },
                                "relatedLocations": {"type": "array", "items": LOCATION},
                            },
                        },
                    },
                },
            },
        },
    },
}


def run_of(*diagnostics: Diagnostic) -> dict[str, Any]:
    log = json.loads(render(diagnostics, SOURCES))
    jsonschema.validate(log, SCHEMA)
    return log["runs"][0]


def test_the_report_has_the_agreed_shape() -> None:
    run = run_of(*REPORT)
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == sorted({d.code for d in REPORT})
    assert all(rules[result["ruleIndex"]] == result["ruleId"] for result in run["results"])
    assert len(run["results"]) == 7
    for rule in run["tool"]["driver"]["rules"]:
        assert rule["fullDescription"]["text"] == registry()[rule["id"]].explanation


def test_an_empty_report_is_a_whole_document() -> None:
    run = run_of()
    assert run["results"] == []
    assert run["tool"]["driver"]["rules"] == []


def test_a_diagnostic_without_place_is_a_notification() -> None:
    run = run_of(Diagnostic("X001", "shotc failed"))
    assert run["results"] == []
    (notification,) = run["invocations"][0]["toolConfigurationNotifications"]
    assert notification["descriptor"] == {"id": "X001", "index": 0}


def test_places_are_ours() -> None:
    (result,) = run_of(Diagnostic("Y020", "m", (at(6, 16, 20),)))["results"]
    physical = result["locations"][0]["physicalLocation"]
    assert physical["artifactLocation"]["uri"] == "specs/tower.yaml"
    assert physical["region"] == {"startLine": 6, "startColumn": 16, "endLine": 6, "endColumn": 20}


def test_an_empty_span_has_no_end() -> None:
    (result,) = run_of(Diagnostic("Y020", "m", (at(6, 16, 16),)))["results"]
    region = result["locations"][0]["physicalLocation"]["region"]
    assert region == {"startLine": 6, "startColumn": 16}


@pytest.mark.parametrize(
    ("name", "uri"),
    [
        ("./a b.yaml", "a%20b.yaml"),
        ("カ.yaml", "%E3%82%AB.yaml"),
        ("a\\b.yaml", "a/b.yaml"),
        ("\udcff", "%ED%B3%BF"),
    ],
)
def test_names_become_uris(name: str, uri: str) -> None:
    label = replace(at(1, 1, 2), file=name)
    (result,) = run_of(Diagnostic("Y020", "m", (label,)))["results"]
    assert result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == uri


def test_fingerprints_outlast_lines_added_above() -> None:
    def fingerprints(file: SourceFile, line: int) -> list[str]:
        found = [Diagnostic("Y020", "m", (replace(at(1, 1, 2), span=Span(line, 3, line, 4)),))]
        run = json.loads(render(found, {file.name: file}))["runs"][0]
        return [result["partialFingerprints"]["primaryLocationLineHash"] for result in run["results"]]

    longer = SourceFile(MISSION.name, "# a\n# b\n" + MISSION.text)
    assert fingerprints(MISSION, 4) == fingerprints(longer, 6)
    assert fingerprints(MISSION, 4) != fingerprints(MISSION, 6)


def test_equal_lines_have_fingerprints_of_their_own() -> None:
    found = [Diagnostic("Y020", "m", (at(9, column, column + 1),)) for column in (5, 7, 9)]
    results = run_of(*found)["results"]
    assert len({r["partialFingerprints"]["primaryLocationLineHash"] for r in results}) == 3
