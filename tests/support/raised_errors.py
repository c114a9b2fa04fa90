"""Which exceptions a public function raises, read from its source."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

Function = ast.FunctionDef | ast.AsyncFunctionDef
EVERYTHING = frozenset({"Exception", "BaseException"})
UNHANDLED = frozenset({"AssertionError", "KeyboardInterrupt", "NotImplementedError", "SystemExit"})
"""What no caller is to handle."""


class Place(NamedTuple):
    """A function of a module; ``owner`` is its class, or empty."""

    owner: str
    name: str

    def __str__(self) -> str:
        return f"{self.owner}.{self.name}".lstrip(".")

    @property
    def public(self) -> bool:
        """Whether no part of its name is private."""
        return not self.owner.startswith("_") and not self.name.startswith("_")


class Step(NamedTuple):
    """A node of a function's body.

    caught : the exceptions that a ``try`` around it handles
    handled : those that the handler around it handles
    """

    node: ast.AST
    caught: frozenset[str]
    handled: frozenset[str]


@dataclass
class Source:
    """The functions of a module, and names of the whole package.

    bases : the base classes of each class of the package
    makers : the exception that each function of the package returns
    """

    bases: dict[str, frozenset[str]]
    makers: dict[str, str]
    functions: dict[Place, Function] = field(default_factory=dict)

    def raised(self, place: Place, seen: frozenset[Place] = frozenset()) -> frozenset[str]:
        """Return what a function raises, by itself or by private functions of its module."""
        if place in seen or place not in self.functions:
            return frozenset()
        out: set[str] = set()
        for step in steps(self.functions[place].body):
            if isinstance(step.node, ast.Raise):
                out |= self._left(self._names(step), step.caught)
            elif isinstance(step.node, ast.Call) and (callee := _private_callee(step.node, place)):
                out |= self._left(self.raised(callee, seen | {place}), step.caught)
        return frozenset(out - UNHANDLED - EVERYTHING)

    def kin(self, name: str) -> frozenset[str]:
        """Return the class and all its bases."""
        return frozenset({name}).union(*(self.kin(base) for base in self.bases.get(name, ())))

    def _left(self, names: Iterable[str], caught: frozenset[str]) -> set[str]:
        return {n for n in names if not (caught & (self.kin(n) | EVERYTHING))}

    def _names(self, step: Step) -> frozenset[str]:
        assert isinstance(step.node, ast.Raise)
        raised = step.node.exc
        called = raised.func if isinstance(raised, ast.Call) else raised
        name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
        if name.lstrip("_")[:1].isupper():
            return frozenset({name})
        makes = isinstance(raised, ast.Call) and name in self.makers
        return frozenset({self.makers[name]}) if makes else step.handled


def steps(
    nodes: Iterable[ast.AST], caught: frozenset[str] = frozenset(), handled: frozenset[str] = frozenset()
) -> Iterator[Step]:
    """Yield the nodes below; functions and classes inside run at another time."""
    for node in nodes:
        if isinstance(node, Function | ast.ClassDef | ast.Lambda):
            continue
        yield Step(node, caught, handled)
        if isinstance(node, ast.Try):
            here = frozenset(n for h in node.handlers for n in _types(h.type))
            yield from steps(node.body, caught | here, handled)
            yield from steps([*node.orelse, *node.finalbody], caught, handled)
            for handler in node.handlers:
                yield from steps(handler.body, caught, frozenset(_types(handler.type)))
        else:
            yield from steps(ast.iter_child_nodes(node), caught, handled)


def _types(caught: ast.expr | None) -> list[str]:
    if caught is None:
        return ["BaseException"]
    parts = caught.elts if isinstance(caught, ast.Tuple) else [caught]
    return [ast.unparse(part).rpartition(".")[2] for part in parts]


def _private_callee(call: ast.Call, place: Place) -> Place | None:
    called = call.func
    if isinstance(called, ast.Name) and called.id.startswith("_"):
        return Place("", called.id)
    if isinstance(called, ast.Attribute) and ast.unparse(called.value) in {"self", "cls"}:
        return Place(place.owner, called.attr) if called.attr.startswith("_") else None
    return None


def sources(trees: dict[Path, ast.Module]) -> dict[Path, Source]:
    """Return what is known of each module of a package."""
    classes = [c for tree in trees.values() for c in tree.body if isinstance(c, ast.ClassDef)]
    bases = {c.name: frozenset(n for b in c.bases for n in _types(b)) for c in classes}
    makers = {
        f.name: made
        for tree in trees.values()
        for f in tree.body
        if isinstance(f, Function) and (made := _made(f.returns, bases))
    }
    return {path: Source(bases, makers, _functions(tree)) for path, tree in trees.items()}


def _made(returned: ast.expr | None, bases: dict[str, frozenset[str]]) -> str:
    """Return the exception that an annotation names; empty if it names none."""
    name = ast.unparse(returned) if isinstance(returned, ast.Name) else ""
    above = {name} | bases.get(name, frozenset())
    return name if any(re.search(r"(Error|Exception)$", n) for n in above) else ""


def _functions(tree: ast.Module) -> dict[Place, Function]:
    out: dict[Place, Function] = {}
    for owner in [tree, *(c for c in tree.body if isinstance(c, ast.ClassDef))]:
        name = owner.name if isinstance(owner, ast.ClassDef) else ""
        out |= {Place(name, f.name): f for f in owner.body if isinstance(f, Function)}
    return out
