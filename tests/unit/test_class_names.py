"""One word means one thing: no two public classes have one name."""

from __future__ import annotations

import ast
from collections import defaultdict

import pytest

from tests.support.modules import modules

RECORDED = {"Model"}
"""``ir.show.Model`` keeps its name, since plans have it; ``spec.model.Model`` is no word of the field."""


@pytest.mark.long
def test_no_two_public_classes_have_one_name() -> None:
    places = defaultdict(list)
    for path, module in modules().items():
        for node in module.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(path.as_posix())
    assert len(places) > 700
    assert {name: where for name, where in places.items() if len(where) > 1 and name not in RECORDED} == {}
