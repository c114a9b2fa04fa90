"""Draw the missions whose plans are recorded, or write digests of all that is planned and emitted.

``python -m tests.golden --draw 5000:5040`` writes missions of the generator, small ones, for good: what is
drawn later is another mission. ``--digests FILE`` writes a digest of every file of every plan, for the same
machine before and after a change that is to change nothing: ``diff`` then shows what it did change.
"""

from __future__ import annotations

import argparse
from hashlib import sha256
from pathlib import Path

from shotc import api
from tests.golden.missions import DRAWN, missions
from tests.support.compiled import compiled
from tests.support.generated.judge import write
from tests.support.generated.missions import mission

DRONES, SHOTS = 2, 2
EMITTERS = ("csv", "mavlink", "storyboard")


def main() -> None:
    """Run one of both."""
    parser = argparse.ArgumentParser(prog="python -m tests.golden", description=__doc__)
    parser.add_argument("--draw", metavar="FROM:TO", help="seeds of missions to write")
    parser.add_argument("--digests", type=Path, metavar="FILE", help="where to write digests")
    options = parser.parse_args()
    if options.draw:
        draw(range(*map(int, options.draw.split(":"))))
    if options.digests:
        options.digests.write_text("".join(digests()), encoding="utf-8")


def draw(seeds: range) -> None:
    """Write the missions of seeds, each into a folder of its own."""
    for seed in seeds:
        drawn = mission(seed, most_drones=DRONES, most_takes=SHOTS)
        folder = DRAWN / f"{seed}-{drawn.theme}"
        folder.mkdir(parents=True)
        write(drawn, folder)


def digests() -> list[str]:
    """Return a line for every file of every plan: its digest, its mission and its name."""
    return [line for name, path in missions().items() for line in _digests(name, path)]


def _digests(name: str, path: Path) -> list[str]:
    plan = compiled(path).plan
    assert plan is not None
    artifacts = api.emit_plan(plan, EMITTERS).artifacts
    return [f"{sha256(artifact.data).hexdigest()} {name} {artifact.name}\n" for artifact in artifacts]


if __name__ == "__main__":
    main()
