"""Plan missions by seed and tell what became of them: ``python -m tests.support.generated --seeds 0:1000``.

``--dump DIR`` writes the missions, one folder a seed, instead of planning them.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from statistics import median

from tests.support.generated.judge import REFINER_FAILED, Verdict, judge, write
from tests.support.generated.missions import mission

SLOWEST = 8  # missions listed


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the report, and return 1 where a mission was refused or a shot falls short."""
    options = _parser().parse_args(arguments)
    if options.dump is not None:
        for seed in options.seeds:
            folder = options.dump / f"seed-{seed}"
            folder.mkdir(parents=True, exist_ok=True)
            print(write(mission(seed, options.drones, options.shots), folder))
        return 0
    verdicts = []
    for verdict in _verdicts(options):
        verdicts.append(verdict)
        if options.each:
            print(_line(verdict), flush=True)
        elif sys.stderr.isatty():
            print(f"\r{len(verdicts)} of {len(options.seeds)}", end="", file=sys.stderr)
    print(report(verdicts))
    return int(any(not v.planned or any(s.falls_short for s in v.shots) for v in verdicts))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.support.generated", description=__doc__)
    parser.add_argument(
        "--seeds", type=_seeds, default=range(100), help="one, FROM:TO, or several with commas"
    )
    parser.add_argument("--jobs", type=int, default=1, help="missions planned at once")
    parser.add_argument("--refiner", default=None)
    parser.add_argument("--drones", type=int, default=4, help="drones of a mission at most")
    parser.add_argument("--shots", type=int, default=3, help="shots of a drone at most")
    parser.add_argument("--each", action="store_true", help="a line for every mission")
    parser.add_argument("--dump", type=Path, default=None, help="a folder to write the missions to")
    return parser


def _seeds(text: str) -> Sequence[int]:
    if ":" in text:
        first, _, last = text.partition(":")
        return range(int(first), int(last))
    return [int(part) for part in text.split(",")]


def one(seed: int, options: argparse.Namespace) -> Verdict:
    """Draw and plan the mission of a seed."""
    return judge(mission(seed, options.drones, options.shots), options.refiner)


def _verdicts(options: argparse.Namespace) -> Iterable[Verdict]:
    work = partial(one, options=options)
    if options.jobs == 1:
        yield from map(work, options.seeds)
        return
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with get_context("spawn").Pool(options.jobs) as pool:
        yield from pool.imap(work, options.seeds)


def report(verdicts: Sequence[Verdict]) -> str:
    """Return what became of missions: how many are planned, what refused the others, what falls short."""
    planned = [v for v in verdicts if v.planned]
    shots = [(v, s) for v in planned for s in v.shots]
    short = [(v, s) for v, s in shots if s.falls_short]
    refiner = [v.seed for v in verdicts if any(code in REFINER_FAILED for code, _ in v.errors)]
    lines = [
        f"planned      {len(planned)} of {len(verdicts)} ({len(planned) / max(1, len(verdicts)):.2%})",
        f"refiner      {len(refiner)} end in {' or '.join(REFINER_FAILED)}",
        f"whole        {len(shots) - len(short)} of {len(shots)} shots show all that geometry allows",
    ]
    lines += [f"  refused    {code}: {_numbers(seeds)}" for code, seeds in _refused(verdicts).items()]
    for verdict, shot in sorted(short, key=lambda pair: pair[1].share):
        told = f"{shot.kind}, refiner: {shot.refined or 'none'}, {verdict.theme}, {verdict.drones} drones"
        lines.append(f"  below      seed {verdict.seed} shot {shot.id}: {shot.share:.1%} ({told})")
    if verdicts:
        times = sorted(v.seconds for v in verdicts)
        lines.append(
            f"time         median {median(times):.2f} s, worst {times[-1]:.1f} s, all {sum(times):.0f} s"
        )
        slow = sorted(verdicts, key=lambda v: -v.seconds)[:SLOWEST]
        lines.append("  slowest    " + ", ".join(f"{v.seed} ({v.seconds:.1f} s)" for v in slow))
    return "\n".join(lines)


def _refused(verdicts: Sequence[Verdict]) -> dict[str, list[int]]:
    found: dict[str, list[int]] = defaultdict(list)
    for verdict in verdicts:
        for code in dict.fromkeys(code for code, _ in verdict.errors):
            found[code].append(verdict.seed)
    return dict(sorted(found.items(), key=lambda item: -len(item[1])))


def _numbers(seeds: Sequence[int]) -> str:
    return f"{len(seeds)}, seeds {', '.join(map(str, seeds))}"


def _line(verdict: Verdict) -> str:
    told = "; ".join(f"{code} {message}" for code, message in verdict.errors) or " ".join(
        f"{s.id}:{s.share:.3f}{'!' if s.falls_short else ''}" for s in verdict.shots
    )
    return f"{verdict.seed:5d} {verdict.theme:9} {verdict.drones} {verdict.seconds:6.2f} s  {told}"


if __name__ == "__main__":
    sys.exit(main())
