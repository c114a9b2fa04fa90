"""`make mutants`: put seeded faults into the source, one at a time, and see whether a test fails.

The suite is run once, to record which tests run which lines; later only tests of new text are, unless the
source has changed. Each mutant then meets only the tests that run its statement, with a limit of CPU time,
in a copy of the tree: first the test that killed it in an earlier campaign. What survived the same tests
before is not tried again. A test that fails in the copy without the fault, too, does not count. The report
lists what survived, and goes to ``out/mutants/report.txt``. The exit status is 1 where fewer are killed than
shall be.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue

from tests.experiments.mutants.changes import Mutant, mutants
from tests.experiments.mutants.coverage_map import CoverageMap, recorded
from tests.experiments.mutants.equivalents import is_equivalent
from tests.experiments.mutants.trial import Bench, Trial

ROOT = Path(__file__).resolve().parents[3]
OUT = ROOT / "out" / "mutants"
PATHS = ("shotc/passes/verify", "shotc/geom", "shotc/solvers", "shotc/show/geom", "shotc/show/solvers")
KILLED_SHARE = 0.9
"""Of the mutants that are not equivalent, at least so many shall be killed."""


def main() -> None:
    """Draw, try and report."""
    options = _options()
    drawn = draw(every(options.paths), options.number, options.seed)[options.skip :]
    print(f"{len(drawn)} mutants of {' '.join(options.paths)}, seed {options.seed}", flush=True)
    covered = recorded(OUT / "record", PATHS, ROOT, options)
    trials = list(tries(drawn, covered, options))
    text, share = report(trials)
    (OUT / "report.txt").write_text(text, encoding="utf-8")
    print(text)
    sys.exit(share < KILLED_SHARE)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.experiments.mutants", description=__doc__)
    parser.add_argument("--number", type=int, default=1000, help="how many mutants (1000)")
    parser.add_argument(
        "--skip", type=int, default=0, help="how many of these to leave out, from the first (0)"
    )
    parser.add_argument("--seed", type=int, default=0, help="which of them (0)")
    parser.add_argument("--jobs", type=int, default=2, help="how many at once (2)")
    parser.add_argument("--longest", type=float, default=120.0, help="CPU seconds of tests per mutant (120)")
    parser.add_argument("--record", action="store_true", help="record anew which tests run which lines")
    parser.add_argument(
        "--tests", default="", help="what pytest is told when it records: \"-m 'not slow' tests/unit\""
    )
    parser.add_argument("paths", nargs="*", default=PATHS, help="files or folders of those that are recorded")
    return parser.parse_args()


def every(paths: Sequence[str]) -> list[Mutant]:
    """Return all mutants of all modules under some paths."""
    roots = [ROOT / path for path in paths]
    files = [f for root in roots for f in (sorted(root.rglob("*.py")) if root.is_dir() else [root])]
    named = [(f.relative_to(ROOT).as_posix(), f.read_text(encoding="utf-8")) for f in files]
    return [mutant for name, text in named for mutant in mutants(name, text)]


def draw(found: Sequence[Mutant], number: int, seed: int) -> list[Mutant]:
    """Return so many mutants drawn by a seed: a longer draw starts with a shorter one.

    Each has a random number of its own, so that a change of the source changes the draw where it is alone.
    """
    ranks = [random.Random(f"{seed} {mutant.nth} {mutant.key}").random() for mutant in found]
    return [found[k] for k in sorted(range(len(found)), key=ranks.__getitem__)[:number]]


def tries(drawn: Sequence[Mutant], covered: CoverageMap, options: argparse.Namespace) -> Iterator[Trial]:
    """Try mutants side by side, each worker in a copy of its own, and say how each ends."""
    tests = sorted({test for mutant in drawn for test in covered.tests(mutant)})
    free: SimpleQueue[Bench] = SimpleQueue()

    def begin(number: int) -> Bench:
        copy, remembered = OUT / f"copy-{number}", OUT / "memory.jsonl"
        bench = Bench(ROOT, copy, covered, tests, remembered=remembered, longest=options.longest)
        free.put(bench)
        return bench

    def one(mutant: Mutant) -> Trial:
        if is_equivalent(mutant):
            return Trial(mutant, "equivalent", 0)
        bench = free.get()
        try:
            return bench.tried(mutant)
        finally:
            free.put(bench)

    with ThreadPoolExecutor(options.jobs) as pool:
        benches = list(pool.map(begin, range(options.jobs)))
        for trial in pool.map(one, drawn):
            print(line(trial), flush=True)
            yield trial
    for bench in benches:
        bench.close()


def line(trial: Trial) -> str:
    """Return what became of a mutant, on one line."""
    mutant = trial.mutant
    place = f"{mutant.path}:{mutant.line}:{mutant.column}"
    return f"{trial.verdict:10} {place}  {mutant.change}  in  {mutant.source}"


def report(trials: Sequence[Trial]) -> tuple[str, float]:
    """Return the report and the share of mutants killed, of those that are not equivalent."""
    ends = ("killed", "timeout", "survived", "uncovered", "equivalent")
    counts = {end: sum(t.verdict == end for t in trials) for end in ends}
    faults = len(trials) - counts["equivalent"]
    share = (counts["killed"] + counts["timeout"]) / faults if faults else 1.0
    alive = [t for t in trials if t.verdict in {"survived", "uncovered"}]
    lines = [
        f"{len(trials)} mutants: {', '.join(f'{n} {end}' for end, n in counts.items())}",
        f"{share:.1%} of those that are not equivalent are killed (at least {KILLED_SHARE:.0%})",
        *(line(t) for t in sorted(alive, key=lambda t: (t.mutant.path, t.mutant.start))),
    ]
    return "\n".join([*lines, ""]), share


if __name__ == "__main__":
    main()
