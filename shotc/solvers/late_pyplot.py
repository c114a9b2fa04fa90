"""A late import of pyplot for toppra, which uses it for plots that we never draw.

Loading pyplot takes longer than the rest of toppra.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

PYPLOT = "matplotlib.pyplot"


class _LateModule(ModuleType):
    """A module that loads at the first access to an attribute."""

    def __getattr__(self, name: str) -> Any:
        if sys.modules.get(self.__name__) is self:  # during the import nothing is needed yet
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


@contextmanager
def late_pyplot() -> Iterator[None]:
    """Give imports inside the block a pyplot that loads at first use; other modules do not see it."""
    absent = [name for name in ("matplotlib", PYPLOT) if name not in sys.modules]
    sys.modules.update((name, _LateModule(name)) for name in absent)
    try:
        yield
    finally:
        for name in absent:
            del sys.modules[name]
