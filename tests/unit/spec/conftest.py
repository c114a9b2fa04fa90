from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

import shotc.kinds
from shotc.spec.load import Loaded, load
from shotc.spec.shot import ShotBase

WHOLE_LANGUAGE = Path(__file__).with_name("whole_language.yaml").read_text(encoding="utf-8")


def kind_models() -> dict[str, type[ShotBase]]:
    modules = [import_module(f"shotc.kinds.{found.name}") for found in iter_modules(shotc.kinds.__path__)]
    found = [module.KIND for module in modules if hasattr(module, "KIND")]
    return {kind.name: kind.model for kind in found}


@pytest.fixture(scope="session")
def kinds() -> Mapping[str, type[ShotBase]]:
    return kind_models()


@pytest.fixture(scope="session")
def loads(kinds: Mapping[str, type[ShotBase]]) -> Callable[[str], Loaded]:
    return lambda text: load(text.encode(), "m.yaml", None, kinds)


@pytest.fixture(scope="session")
def whole_language() -> str:
    """A mission that uses every part of the language."""
    return WHOLE_LANGUAGE
