"""Constants: the name of a number says of what it is, and ends with its unit or its quantity."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import pytest

from tests.support.modules import modules

UNITS = re.compile(r"K?M[23]?|[CDM]M|IN|PT|PX|DB|M?S[23]?|HZ|FPS|RAD2?|DEG(?:REES)?|WH|EPSG")
QUANTITIES = re.compile(
    "SHARE|RATIO|WEIGHT|PRICE|COST|TOLERANCE|VARIANCE|RESIDUAL|CHI2|DPI|ASPECT|FLATTENING|SLOPE|SINE|COSINE"
    "|VERSINE|SCALAR|LEVEL|DV|POWER|SIZE|VALUE|NUMBER|COORDINATE|PARAMETER|LACK|WIDTH|SQUARE"
    "|FRAMES|SIDES|EDGES|RADII|SPACINGS|DEVIATIONS|PERIODS|LEVELS"
)
"""Quantities without a unit, and lengths in parts of something: HALF_FRAMES."""
SINGLE = frozenset({"ASPECT", "DEGREE", "DPI", "FLATTENING", "VERSION"})
"""Words that say enough alone."""
CODES = frozenset({"INTERRUPTED", "LOOSE", "NOBODY", "NOTHING", "PAIR", "QUADROTOR"})
"""Whole numbers that stand for something; their size means nothing."""


def vague(module: ast.Module) -> Iterator[str]:
    """Yield the names of numbers of a module that lack their unit, their quantity, or of what they are."""
    for node in module.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        for name in (t.id for t in targets if isinstance(t, ast.Name) and t.id.isupper()):
            if (value := _number(getattr(node, "value", None))) is not None and _is_vague(name, value):
                yield name


def _number(node: ast.expr | None) -> float | None:
    """Return the value of a literal, also of a negative one or of a product of two; None of anything else."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return node.value
    if isinstance(node, ast.UnaryOp):
        return _number(node.operand)
    if isinstance(node, ast.BinOp):
        left, right = _number(node.left), _number(node.right)
        return None if left is None or right is None else left + 0 * right
    return None


def _is_vague(name: str, value: float) -> bool:
    words = name.strip("_").split("_")
    if len(words) == 1:
        return words[0] not in SINGLE | CODES
    counts = isinstance(value, int)
    return not (counts or UNITS.fullmatch(words[-1]) or QUANTITIES.fullmatch(words[-1]) or "PER" in words)


@pytest.mark.long
def test_numbers_have_a_unit_or_a_quantity() -> None:
    found = {f"{path}: {name}" for path, module in modules().items() for name in vague(module)}
    assert len(modules()) > 900
    assert found == set()


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("STEP = 0.5", ["STEP"]),
        ("NEAR: float = -1e-3", ["NEAR"]),
        ("SAMPLES = 8", ["SAMPLES"]),
        ("FAR_AWAY = 1e5", ["FAR_AWAY"]),
        ("HALF_WAY = 3.0 * 2", ["HALF_WAY"]),
        ("STEP_S = 0.5", []),
        ("PIECE_SAMPLES = 8", []),
        ("MOST_TURNS_PER_WAY = 1.5", []),
        ("OFF_HALF_FRAMES = 0.5", []),
        ("DEGREE = 5", []),
        ("NAMES = ('a', 'b')", []),
        ("IS_LATE = True", []),
    ],
)
def test_a_vague_name_is_recognised(text: str, names: list[str]) -> None:
    assert list(vague(ast.parse(text))) == names
