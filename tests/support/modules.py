"""The modules of shotc and of its plugins, as trees, for tests of the source itself."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = (ROOT / "shotc", *sorted((ROOT / "plugins").glob("*/shotc_*")))


@cache
def modules() -> dict[Path, ast.Module]:
    """Return the trees by their paths from the root, in a fixed order."""
    paths = [path for package in PACKAGES for path in sorted(package.rglob("*.py"))]
    return {path.relative_to(ROOT): ast.parse(path.read_text(encoding="utf-8")) for path in paths}
