"""`python -m tests.experiments.bench.late_imports` prints the table of imports inside functions.

It stands in architecture.md. The milliseconds are CPU time of loading the module in a process that has loaded
the one that asks for it, the least of some runs. What stands below ``LEAST`` belongs at the top.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

PACKAGE = Path(__file__).resolve().parents[3] / "shotc"
LEAST = 5.0
"""Milliseconds that an import inside a function has to save."""
BY_NAME = "by name"
"""What stands in the table for a module whose name is known at run time only."""
RUNS = 3
INDENTED = re.compile(r"^ .*\b(?:import |import_module\()", re.MULTILINE)
"""What every import inside a function has in its text."""
SCRIPT = """
import importlib, sys, time
importlib.import_module(sys.argv[1])
began = time.process_time()
importlib.import_module(sys.argv[2])
print(1000 * (time.process_time() - began))
"""


class LateImport(NamedTuple):
    """A module, and the file under shotc/ that imports it inside a function."""

    module: str
    file: str


def late_imports() -> set[LateImport]:
    """Return every import inside a function under shotc/."""
    found = set()
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        text = path.read_text(encoding="utf-8")
        if not INDENTED.search(text):
            continue
        functions = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.FunctionDef)]
        found |= {LateImport(name, file) for function in functions for name in _imported(function)}
    return found


def _imported(function: ast.FunctionDef) -> Iterator[str]:
    for node in ast.walk(function):
        match node:
            case ast.Import():
                yield from (alias.name for alias in node.names)
            case ast.ImportFrom(module=str(module)):
                yield module
            case ast.Call(func=ast.Name(id="import_module")):
                yield BY_NAME


def milliseconds(late: LateImport) -> float:
    """Return how long it takes to load a module after the one that asks for it."""
    asking = ".".join(["shotc", *Path(late.file).with_suffix("").parts]).removesuffix(".__init__")
    command = [sys.executable, "-c", SCRIPT, asking, late.module]
    return min(
        float(subprocess.run(command, capture_output=True, text=True, check=True).stdout) for _ in range(RUNS)
    )


def main() -> None:
    """Print the table."""
    for late in sorted(late_imports()):
        if late.module != BY_NAME:
            print(f"| `{late.module}` | `{late.file}` | {milliseconds(late):.0f} |", flush=True)


if __name__ == "__main__":
    main()
