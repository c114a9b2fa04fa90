"""A fault put into modules that are loaded already: the code of functions is exchanged, and constants are."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterable, Iterator
from types import CodeType, FunctionType
from typing import Any


class NotPatchedError(Exception):
    """A fault of which loaded modules would see nothing: its module must be imported anew."""


def loaded_functions() -> dict[str, list[FunctionType]]:
    """Return the functions that there are, by the file that they come from."""
    gc.unfreeze()
    found: dict[str, list[FunctionType]] = {}
    for each in gc.get_objects():
        if isinstance(each, FunctionType):
            found.setdefault(each.__code__.co_filename, []).append(each)
    gc.freeze()
    return found


def patch(functions: Iterable[FunctionType], path: str, old: str, new: str) -> None:
    """Give functions of a file the code that they have in another text of it.

    old, new : the text that was loaded, and the one with the fault, which has the same functions and classes

    Raises
    ------
    NotPatchedError
        when more differs than the bodies of functions, or it is not clear which loaded function has it
    """
    before, after = (list(_functions(compile(text, path, "exec"))) for text in (old, new))
    if _plain(compile(old, path, "exec")) != _plain(compile(new, path, "exec")):
        raise NotPatchedError
    places = [_place(code) for code in before]
    code = {_place(a): b for a, b in zip(before, after, strict=True) if _whole(a) != _whole(b)}
    if any(places.count(place) > 1 for place in code):
        raise NotPatchedError
    patched = False
    for function in functions:
        if (other := code.get(_place(function.__code__))) is not None:
            function.__code__ = other
            patched = True
    if not patched:
        raise NotPatchedError


def patch_constants(path: str, old: str, new: str) -> None:
    """Give loaded modules the constants that a module has in another text, where they hold what it has.

    What other modules have made of a constant when they were imported stays.

    Raises
    ------
    NotPatchedError
        when no constant differs, or the module is not loaded
    """
    name = next((n for n, m in sys.modules.items() if getattr(m, "__file__", None) == path), None)
    if name is None:
        raise NotPatchedError
    before, after = (_constants(name, compile(text, path, "exec")) for text in (old, new))
    changed = {key: value for key, value in after.items() if repr(before.get(key)) != repr(value)}
    if not changed:
        raise NotPatchedError
    for module in list(sys.modules.values()):
        held = getattr(module, "__dict__", {})
        for key, value in changed.items():
            if key in held and repr(held[key]) == repr(before[key]):
                held[key] = value


def _constants(name: str, code: CodeType) -> dict[str, Any]:
    held: dict[str, Any] = {"__name__": name}
    exec(code, held)
    return {key: value for key, value in held.items() if isinstance(value, int | float | tuple | slice)}


def _place(code: CodeType) -> tuple[str, int]:
    return code.co_qualname, code.co_firstlineno


def _functions(code: CodeType) -> Iterator[CodeType]:
    """Return the outermost functions of a module or class body, in the order of the text."""
    for part in code.co_consts:
        if isinstance(part, CodeType):
            yield from (part,) if _is_function(part) else _functions(part)


def _is_function(code: CodeType) -> bool:
    return bool(code.co_flags & 0x2)  # CO_NEWLOCALS: a class body keeps its names in a namespace of its own


def _plain(code: CodeType) -> tuple[object, ...]:
    """Return what a module or class body does besides its functions, wherever its lines stand."""
    held = tuple(
        (part.co_name if _is_function(part) else _plain(part)) if isinstance(part, CodeType) else _typed(part)
        for part in code.co_consts
    )
    return code.co_code, code.co_names, held


def _whole(code: CodeType) -> tuple[object, ...]:
    """Return what a function does, wherever its lines stand."""
    held = tuple(_whole(part) if isinstance(part, CodeType) else _typed(part) for part in code.co_consts)
    return code.co_code, code.co_names, code.co_varnames, held


def _typed(value: object) -> tuple[str, str]:
    return type(value).__name__, repr(value)
