"""Docstrings: public functions that take or give arrays state their shapes; those that raise state what."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from shotc.cli.app import COMMANDS
from tests.support.modules import modules
from tests.support.raised_errors import Place, Source, sources

SIZE = r"(?:\.\.\.|\d|[A-Za-z]\w*(?: [\w+*-]+)*)"
SHAPE = re.compile(
    rf"\bshapes?\b|\({SIZE}(?:, {SIZE})+\)|\({SIZE},\)|\(\.\.\.\)|[Aa]rguments as (?:in|of) ``"
)
"""The word, or a shape as it is written: (P, 6, 3), (..., 3), (M,); or where they are stated."""


def functions(module: ast.Module) -> Iterator[ast.FunctionDef]:
    """Yield the public functions and methods of a module whose signature speaks of arrays."""
    classes = [c for c in module.body if isinstance(c, ast.ClassDef) and not c.name.startswith("_")]
    for found in (f for body in (module.body, *(c.body for c in classes)) for f in body):
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
        (f"{path}: {function.name}", states_shape(function))
        for path, module in modules().items()
        for function in functions(module)
    ]
    assert len(found) > 600
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
    assert [states_shape(function) for function in functions(ast.parse(text))] == [stated]


WORDS = {
    "PydanticCustomError": re.compile(r"\bfaults?\b"),
    "Exit": re.compile(r"\bexit\b"),
    "BadParameter": re.compile(r"\busage error\b"),
}
"""What these exceptions of pydantic and typer are called in docstrings."""
HELP = {command.place.replace(".", "/").replace(":", ".py: ") for command in COMMANDS.values()}
"""The commands: their docstrings are what ``--help`` prints, which gives the exit statuses of all."""


def unstated(source: Source, place: Place) -> list[str]:
    """Return the exceptions of a function that its docstring names neither by themselves nor by a base."""
    words = ast.get_docstring(source.functions[place]) or ""
    return sorted(
        name
        for name in source.raised(place)
        if not any(re.search(WORDS.get(each, rf"\b{each}\b"), words) for each in source.kin(name))
    )


@pytest.mark.long
def test_public_functions_that_raise_state_what() -> None:
    missing = {
        f"{path}: {place}": unstated(source, place)
        for path, source in sources(modules()).items()
        for place in source.functions
        if place.public and source.raised(place)
    }
    assert len(missing) > 80
    assert missing.keys() >= {"shotc/cli/plan.py: plan", "shotc/spec/music.py: NumberType.read"}
    assert {name: names for name, names in missing.items() if names and name not in HELP} == {}


BODY = '''
class Refused(ValueError): ...
class _Odd(Refused): ...
def refusal(): ...
def made() -> Refused: ...
def _inner(a):
    raise Refused(a)
def f(a):
    """{words}"""
    {body}
'''


@pytest.mark.parametrize(
    ("words", "body", "missing"),
    [
        ("Return it.", "return a", []),
        ("Return it.", "raise KeyError(a)", ["KeyError"]),
        ("Return it. Raise KeyError if it lacks.", "raise KeyError(a)", []),
        ("Return it.", "raise made()", ["Refused"]),
        ("Raise ValueError.", "raise _Odd", []),
        ("Return it.", "raise _Odd", ["_Odd"]),
        ("Return it.", "return _inner(a)", ["Refused"]),
        ("Return it.", "return [_inner(b) for b in a]", ["Refused"]),
        ("Return it.", "def g(): _inner(a)", []),
        ("Return it.", "raise AssertionError", []),
        ("Return it.", "try: _inner(a)\n    except ValueError: pass", []),
        ("Return it.", "try: _inner(a)\n    except (OSError, KeyError): pass", ["Refused"]),
        ("Return it.", "try: a()\n    except OSError: raise", ["OSError"]),
        ("Return it.", "try: a()\n    except Exception: raise", []),
        ("Return it.", "try: a()\n    finally: _inner(a)", ["Refused"]),
    ],
)
def test_what_is_raised_is_recognised(words: str, body: str, missing: list[str]) -> None:
    path = Path("module.py")
    source = sources({path: ast.parse(BODY.format(words=words, body=body))})[path]
    assert unstated(source, Place("", "f")) == missing
