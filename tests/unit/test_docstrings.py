"""Docstrings: public functions that take or give arrays state their shapes."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "shotc"
SIZE = r"(?:\.\.\.|\d|[A-Za-z]\w*(?: [\w+*-]+)*)"
SHAPE = re.compile(
    rf"\bshapes?\b|\({SIZE}(?:, {SIZE})+\)|\({SIZE},\)|\(\.\.\.\)|[Aa]rguments as (?:in|of) ``"
)
"""The word, or a shape as it is written: (P, 6, 3), (..., 3), (M,); or where they are stated."""


def functions(text: str) -> Iterator[ast.FunctionDef]:
    """Yield the public functions of a module whose signature speaks of arrays."""
    for found in ast.parse(text).body:
        if isinstance(found, ast.FunctionDef) and not found.name.startswith("_"):
            arguments = [*found.args.posonlyargs, *found.args.args, *found.args.kwonlyargs]
            types = [a.annotation for a in arguments] + [found.returns]
            if any(re.search(r"\bArray\b", ast.unparse(t)) for t in types if t is not None):
                yield found


def states_shape(function: ast.FunctionDef) -> bool:
    """Return whether a docstring states a shape."""
    return bool(SHAPE.search(ast.get_docstring(function) or ""))


@pytest.mark.long
def test_public_functions_with_arrays_state_their_shapes() -> None:
    found = [
        (f"{path.relative_to(PACKAGE)}: {function.name}", states_shape(function))
        for path in sorted(PACKAGE.rglob("*.py"))
        for function in functions(path.read_text(encoding="utf-8"))
    ]
    assert len(found) > 400
    assert [name for name, stated in found if not stated] == []


@pytest.mark.parametrize(
    ("words", "stated"),
    [
        ("Return points, shape (M, 3).", True),
        ("Return the norms (...) of vectors (..., D).", True),
        ("Return times (M,).", True),
        ("Return it; arguments as in ``closest``.", True),
        ("Return the points (as there) of a curve (in W).", False),
        ("", False),
    ],
)
def test_a_shape_is_recognised(words: str, stated: bool) -> None:
    text = f'def f(a: Array | None) -> float:\n    """{words}"""\n\ndef _g(a: Array): ...\n'
    assert [states_shape(function) for function in functions(text)] == [stated]
