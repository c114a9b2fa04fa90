"""All mutants of a module: small changes of its syntax tree, each written back as one edit of its text.

A comparison of floats is turned round, not moved to its boundary: ``<`` against ``<=`` differ on a set of
measure zero, so that nearly all of those mutants are equivalent. Where whole numbers are compared (a length,
a whole literal other than zero, a remainder) the boundary is tried as well. Tolerances are made a thousand
times wider, other numbers differ by one. Texts, annotations and docstrings are left alone, and so are the
tiny numbers that keep a divisor from zero.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

OPPOSITE = {
    ast.Lt: ">", ast.Gt: "<", ast.LtE: ">=", ast.GtE: "<=", ast.Eq: "!=", ast.NotEq: "==",
    ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
}  # fmt: skip
BOUNDARY = {ast.Lt: "<=", ast.Gt: ">=", ast.LtE: "<", ast.GtE: ">"}
ARITHMETIC = {
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*", ast.Pow: "*",
    ast.MatMult: "*", ast.BitAnd: "|", ast.BitOr: "&",
}  # fmt: skip
CALLS = {
    "min": "max", "max": "min", "any": "all", "all": "any", "minimum": "maximum", "maximum": "minimum",
    "argmin": "argmax", "argmax": "argmin", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin",
    "zeros": "ones", "ones": "zeros", "amin": "amax", "amax": "amin", "logical_and": "logical_or",
    "logical_or": "logical_and", "hstack": "vstack", "cumsum": "cumprod", "sorted": "list", "abs": "float",
}  # fmt: skip
TOLERANCE = 1e-3
"""A float nearer to zero than this one is a tolerance."""

GUARD = 1e-200
"""A float nearer to zero keeps a division from zero: any other one of that kind does as well."""

WIDER = 1000.0


@dataclass(frozen=True)
class Mutant:
    """One edit of a file.

    start, end : offsets in its text, characters; first, last : lines of the statement (of its head where it
    holds others), from 1; line, column : of the edit, from 1; nth : of those of its file with its key, from 0
    """

    path: str
    start: int
    end: int
    new: str
    old: str
    line: int
    column: int
    first: int
    last: int
    source: str
    nth: int = 0

    @property
    def change(self) -> str:
        """What was changed, on one line."""
        return f"{' '.join(self.old.split())}  ->  {' '.join(self.new.split()) or 'nothing'}"

    @property
    def key(self) -> tuple[str, str, str]:
        """What it is known by though lines move: file, text of the line, change."""
        return self.path, self.source, self.change

    def applied(self, text: str) -> str:
        """Return the text of the file with this fault in it."""
        return text[: self.start] + self.new + text[self.end :]


def mutants(path: str, text: str) -> list[Mutant]:
    """Return all mutants of a module, in the order of the text."""
    found = _Finder(path, text)
    found.visit(ast.parse(text))
    same: Counter[tuple[str, str, str]] = Counter()
    numbered = []
    for mutant in sorted(found.mutants, key=lambda m: (m.start, m.end, m.new)):
        numbered.append(replace(mutant, nth=same[mutant.key]))
        same[mutant.key] += 1
    return numbered


class _Finder(ast.NodeVisitor):
    def __init__(self, path: str, text: str) -> None:
        self.path, self.text = path, text
        self.lines = text.splitlines(keepends=True)
        self.offsets = [0]
        for line in self.lines:
            self.offsets.append(self.offsets[-1] + len(line))
        self.mutants: list[Mutant] = []
        self.statement = (1, 1)
        self.guards: set[ast.expr] = set()

    def at(self, line: int, column: int) -> int:
        """Return the offset of a place in the tree, whose columns count bytes."""
        return self.offsets[line - 1] + len(self.lines[line - 1].encode()[:column].decode())

    def span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self.at(node.lineno, node.col_offset), self.at(node.end_lineno, node.end_col_offset)

    def add(self, start: int, end: int, new: str) -> None:
        line = self.text.count("\n", 0, start) + 1
        column = start - self.offsets[line - 1] + 1
        source = self.lines[line - 1].strip()
        old = self.text[start:end]
        self.mutants.append(Mutant(self.path, start, end, new, old, line, column, *self.statement, source))

    def visit(self, node: ast.AST) -> None:
        outer = self.statement
        if isinstance(node, ast.stmt):
            body = getattr(node, "body", None)
            last = node.end_lineno or node.lineno
            self.statement = (node.lineno, max(node.lineno, body[0].lineno - 1) if body else last)
        super().visit(node)
        self.statement = outer

    def some(self, *nodes: ast.AST | None) -> None:
        for node in nodes:
            if node is not None:
                self.visit(node)

    # What is not code: annotations, docstrings, texts, types.
    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        self.some(node.value)

    def visit_arguments(self, node: ast.arguments) -> None:
        self.some(*node.defaults, *node.kw_defaults)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self.some(node.args, *node.body)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self.some(*node.body)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Leave texts alone: their columns are not told apart before Python 3.12."""

    def visit_keyword(self, node: ast.keyword) -> None:
        """Leave ``strict=True`` of zip alone: like an assertion, it fails at faults alone."""
        if node.arg != "strict":
            self.generic_visit(node)

    def visit_Assert(self, node: ast.Assert) -> None:
        """Leave what is there for the type checker alone."""

    def visit_Import(self, node: ast.Import) -> None:
        """Nothing to change."""

    visit_ImportFrom = visit_Import  # type: ignore[assignment]

    # What is changed.
    def visit_Compare(self, node: ast.Compare) -> None:
        places = [node.left, *node.comparators]
        for a, operator, b in zip(places, node.ops, node.comparators, strict=False):
            start, end = self.between(a, b)
            self.add(start, end, OPPOSITE[type(operator)])
            if type(operator) in BOUNDARY and (_whole(a) or _whole(b)):
                self.add(start, end, BOUNDARY[type(operator)])
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if type(node.op) in ARITHMETIC and not _is_text(node.left) and not _is_type(node):
            self.add(*self.between(node.left, node.right), ARITHMETIC[type(node.op)])
        if isinstance(node.op, ast.Div):
            self.guards |= set(_guards(node.right))
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if type(node.op) in ARITHMETIC:
            self.add(*self.between(node.target, node.value), f"{ARITHMETIC[type(node.op)]}=")
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        new = "or" if isinstance(node.op, ast.And) else "and"
        for a, b in zip(node.values, node.values[1:], strict=False):
            self.add(*self.between(a, b), new)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        start, _ = self.span(node)
        if isinstance(node.op, ast.Not | ast.USub | ast.Invert):
            self.add(start, start + {ast.Not: 3}.get(type(node.op), 1), "")
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self.negate(node.test)
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        self.negate(node.test)
        self.generic_visit(node)

    def negate(self, test: ast.expr) -> None:
        if isinstance(test, ast.Compare | ast.UnaryOp):
            return  # turned round elsewhere
        start, end = self.span(test)
        self.add(start, end, f"not ({self.text[start:end]})")

    def visit_Call(self, node: ast.Call) -> None:
        name = _name(node)
        if name in CALLS:
            _, end = self.span(node.func)
            self.add(end - len(name), end, CALLS[name])
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if node not in self.guards and (new := _other(node.value)) is not None:
            self.add(*self.span(node), new)

    def visit_Continue(self, node: ast.Continue) -> None:
        self.add(*self.span(node), "break")

    def visit_Break(self, node: ast.Break) -> None:
        self.add(*self.span(node), "continue")

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self.add(*self.span(node), "pass")
        self.generic_visit(node)

    def between(self, a: ast.expr, b: ast.expr) -> tuple[int, int]:
        """Return the offsets of the operator between two expressions, without brackets and blanks."""
        start, end = self.span(a)[1], self.span(b)[0]
        first = last = None
        reader = io.StringIO(f"({self.text[start:end].replace(')', ' ').replace('(', ' ')}\n)").readline
        rows = self.text[start:end].split("\n")
        for token in tokenize.generate_tokens(reader):
            if token.type in {tokenize.OP, tokenize.NAME} and token.string not in "()":
                row, column = token.start
                at = start + sum(len(r) + 1 for r in rows[: row - 1]) + column - (row == 1)
                first = at if first is None else first
                last = at + len(token.string)
        assert first is not None
        assert last is not None
        return first, last


def _whole(node: ast.expr) -> bool:
    """Whether an expression is plainly a whole number other than the zero that floats are held against."""
    if isinstance(node, ast.Constant):
        return type(node.value) is int and node.value != 0
    if isinstance(node, ast.BinOp):
        return isinstance(node.op, ast.Mod | ast.FloorDiv) or _whole(node.left) or _whole(node.right)
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") == "len"


def _guards(divisor: ast.expr) -> Iterator[ast.expr]:
    """Yield the least numbers that a divisor may be, by which it is kept from zero."""
    for call in ast.walk(divisor):
        if isinstance(call, ast.Call) and _name(call) in {"max", "maximum", "clip"}:
            yield from (a for a in call.args if isinstance(a, ast.Constant) and _is_tolerance(a.value))


def _name(call: ast.Call) -> str:
    function = call.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _is_tolerance(value: object) -> bool:
    return isinstance(value, float) and 0.0 < abs(value) < TOLERANCE


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _is_type(node: ast.BinOp) -> bool:
    """Whether it is a union of types: ``X | None``, or names in capitals."""
    ends = [node.left, node.right]
    return isinstance(node.op, ast.BitOr) and any(
        (isinstance(e, ast.Constant) and e.value is None) or (isinstance(e, ast.Name) and e.id[0].isupper())
        for e in ends
    )


def _other(value: object) -> str | None:
    if isinstance(value, bool):
        return str(not value)
    if isinstance(value, int):
        return str(value + 1)
    if isinstance(value, float):
        if 0.0 < abs(value) < GUARD:
            return None
        return repr(value * WIDER if _is_tolerance(value) else value + 1.0)
    return None
