"""What earlier campaigns found.

The test that killed a mutant is tried first, and no survivor meets the same tests twice.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.recording import text_digest


class Memory:
    """Killers and survivors of all campaigns in a tree, kept in a file, one record a line.

    tree : folder whose files decide what a test does
    """

    def __init__(self, file: Path, tree: Path) -> None:
        self.file, self.tree = file, tree
        self.rest = _digest_of_all_but_tests(tree)
        self.killers: dict[str, str] = {}
        self.survived: dict[str, str] = {}
        for line in file.read_text(encoding="utf-8").splitlines() if file.is_file() else ():
            record = json.loads(line)
            getattr(self, record["list"])[record["mutant"]] = record["value"]

    def killer(self, mutant: Mutant) -> str:
        """Return the test that killed a mutant the last time, or nothing."""
        return self.killers.get(_name(mutant), "")

    def survives(self, mutant: Mutant, tests: Sequence[str]) -> bool:
        """Whether a mutant has survived these tests, with the same text of all files."""
        return self.survived.get(_name(mutant)) == self._trial(tests)

    def note(self, mutant: Mutant, verdict: str, tests: Sequence[str], killer: str) -> None:
        """Remember the test that kills a mutant, or the tests that it survives."""
        if killer:
            self._note("killers", mutant, killer)
        elif verdict == "survived":
            self._note("survived", mutant, self._trial(tests))

    def _note(self, of: str, mutant: Mutant, value: str) -> None:
        getattr(self, of)[_name(mutant)] = value
        with self.file.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"list": of, "mutant": _name(mutant), "value": value}) + "\n")

    def _trial(self, tests: Sequence[str]) -> str:
        files = sorted({test.partition("::")[0] for test in tests})
        parts = [self.rest, *sorted(tests), *(text_digest(self.tree / file) for file in files)]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _name(mutant: Mutant) -> str:
    return f"{mutant.path} {mutant.start} {mutant.change} {mutant.source}"


def _digest_of_all_but_tests(tree: Path) -> str:
    """Return what tells a tree from another one, its modules of tests aside."""
    files = sorted(
        f for top in ("shotc", "plugins", "specs", "tests") for f in (tree / top).rglob("*") if f.is_file()
    )
    kept = [f for f in files if f.suffix != ".pyc" and not f.name.startswith("test_")]
    lines = [f"{file.relative_to(tree)} {text_digest(file)}" for file in kept]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()
