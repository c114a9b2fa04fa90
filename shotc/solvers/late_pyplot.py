"""toppra imports pyplot, for plots that we never draw; that takes longer than all the rest of toppra."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

PYPLOT = "matplotlib.pyplot"


class _Late(ModuleType):
    """A module that loads when something of it is first used."""

    def __getattr__(self, name: str) -> Any:
        if sys.modules.get(self.__name__) is self:  # what is imported asks for nothing yet
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


@contextmanager
def late_pyplot() -> Iterator[None]:
    """Let what is imported inside see a pyplot that loads when it is used; nobody else sees that one."""
    absent = [name for name in ("matplotlib", PYPLOT) if name not in sys.modules]
    sys.modules.update((name, _Late(name)) for name in absent)
    try:
        yield
    finally:
        for name in absent:
            del sys.modules[name]
