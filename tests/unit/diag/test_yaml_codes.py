"""The codes of the text: every kind of fault has one, and its examples show it."""

from __future__ import annotations

from typing import get_args

import pytest

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes.yaml import CODES, FAULT_CODES, text_diagnostic
from shotc.source.fault import FaultKind
from shotc.source.yaml_tree import parse

SHOWN = [info for info in CODES if info.phase == "check"]


def raised(example: str) -> set[str]:
    data = example.encode().decode("unicode_escape").encode("latin-1")
    return {text_diagnostic(fault, "m").code for fault in parse(data, "m").faults}


def test_every_kind_of_fault_has_its_code() -> None:
    assert set(FAULT_CODES) == set(get_args(FaultKind))
    assert set(FAULT_CODES.values()) < {info.code for info in CODES}
    assert len(set(FAULT_CODES.values())) == len(FAULT_CODES)


@pytest.mark.parametrize("info", SHOWN, ids=lambda info: info.slug)
def test_examples(info: CodeInfo) -> None:
    assert raised(info.failing) == {info.code}
    assert raised(info.passing) == set()


def test_a_related_place_becomes_a_second_label() -> None:
    (fault,) = parse(b"a: 1\na: 2\n", "m").faults
    found = text_diagnostic(fault, "m")
    assert [(label.file, label.span.line, label.text) for label in found.labels] == [
        ("m", 2, ""),
        ("m", 1, "first given here"),
    ]
