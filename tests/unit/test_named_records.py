"""Functions and fields hold named records, no tuples of three or more values of different kinds."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tests.support.modules import modules

LEAST = 3
ARRAYS = frozenset({"Array", "FloatArray", "IntArray", "Index", "Mask", "np.ndarray", "Piecewise"})
"""Several of these in a tuple are seldom of one meaning: coordinates of points have a name, ``Offset``."""
SORT_KEYS = frozenset({"sort_key", "worth"})
"""What these return is only compared."""
POINTS = frozenset({"Spot"})
"""Three coordinates; the height may be above ground, or be missing."""


def nameless(module: ast.Module) -> Iterator[str]:
    """Yield functions, fields and constants that are annotated with such a tuple, and the aliases of one."""
    for node in ast.walk(module):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.name not in SORT_KEYS:
            arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            types = [a.annotation for a in arguments] + [node.returns]
            if any(map(_holds_one, (t for t in types if t is not None))):
                yield node.name
        elif isinstance(node, ast.ClassDef | ast.Module):
            fields = (item for item in node.body if isinstance(item, ast.AnnAssign))
            yield from (ast.unparse(field.target) for field in fields if _holds_one(field.annotation))
        elif isinstance(node, ast.Assign) and _is_type(node.value) and _holds_one(node.value):
            yield from (n for n in map(ast.unparse, node.targets) if n not in POINTS)


def _is_type(value: ast.expr) -> bool:
    return isinstance(value, ast.Subscript | ast.BinOp)


def _holds_one(annotation: ast.expr) -> bool:
    return any(_is_mixed(node) for node in ast.walk(annotation) if isinstance(node, ast.Subscript))


def _is_mixed(node: ast.Subscript) -> bool:
    if ast.unparse(node.value) != "tuple" or not isinstance(node.slice, ast.Tuple):
        return False
    kinds = [ast.unparse(item) for item in node.slice.elts]
    return len(kinds) >= LEAST and (len(set(kinds)) > 1 or kinds[0] in ARRAYS)


@pytest.mark.long
def test_functions_take_and_give_named_records() -> None:
    found = {f"{path}: {name}" for path, module in modules().items() for name in nameless(module)}
    assert len(modules()) > 900
    assert found == set()


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("def f(a: int) -> tuple[int, str, float]: ...", ["f"]),
        ("def f(*, a: list[tuple[Array, Array, Array]]) -> None: ...", ["f"]),
        ("class A:\n    def _g(self, a: tuple[int, str, None] | None) -> None: ...", ["_g"]),
        ("Key = tuple[str, str | None, str]", ["Key"]),
        ("class A:\n    rows: tuple[tuple[Array, Array, Array], ...]", ["rows"]),
        ("best: tuple[float, str, int] | None = None", ["best"]),
        ("def f() -> None:\n    heap: list[tuple[float, int, str]] = []", []),
        ("Spot = tuple[float, float, float | None]", []),
        ("def f(a: tuple[float, float, float], b: tuple[Array, Array]) -> tuple[Array, ...]: ...", []),
        ("def worth(a: int) -> tuple[bool, bool, float]: ...", []),
        ("a = b[c, d, e]", []),
    ],
)
def test_a_nameless_record_is_recognised(text: str, names: list[str]) -> None:
    assert list(nameless(ast.parse(text))) == names
