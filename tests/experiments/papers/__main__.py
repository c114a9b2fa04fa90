"""`make papers`: run the papers' experiments and write their report."""

from __future__ import annotations

import argparse
import os
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path

from shotc import __version__, plugins
from tests.experiments.papers import framing, houses, lenses, page, retiming, solvers, tower
from tests.experiments.papers.missions import Draft, missions
from tests.experiments.papers.report import Section, html, markdown, text
from tests.support.multidrone_originals import ORIGINALS

ROOT = Path(__file__).resolve().parents[3]
OUT = ROOT / "out" / "papers"
PAGE = ROOT / "shotc" / "docs" / "papers.md"
PARTS = (
    "framing",
    "flown",
    "houses",
    "identification",
    "yaw",
    "retiming",
    "multidrone",
    "replanning",
    "fleets",
    "viewpoint",
    "display",
)
MISSIONS = 60


def machine() -> tuple[str, ...]:
    """Return what was measured with, without a name or a path."""
    versions = f"shotc {__version__}, Python {platform.python_version()}, {platform.system()}"
    load = f"load {os.getloadavg()[0]:.1f} when it began"
    return (versions, f"{_processor()}, {os.cpu_count()} cores, {load}")


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.machine()


def sections(parts: tuple[str, ...], count: int, say: Callable[[str], None]) -> list[Section]:
    """Run the parts that are asked for."""
    installed = set(plugins.names("refiners"))
    conditions = tuple(name for name in framing.CONDITIONS if name in installed)
    found: list[Section] = []
    drafts = missions(count)
    found += _films(parts, drafts, conditions, say)
    if "identification" in parts:
        from tests.experiments.papers import identification

        found.append(identification.section(say))
    if "yaw" in parts:
        from tests.experiments.papers import yaw

        say("yaw")
        found.append(Section("Headings", tuple(yaw.tables())))
    if "retiming" in parts:
        found.append(retiming.section(drafts, say))
    if "multidrone" in parts and "ours" in installed:
        from tests.experiments.papers import multidrone

        say("multidrone")
        found.append(multidrone.section())
    if "replanning" in parts and "ours" in plugins.names("replanners"):
        from tests.experiments.papers import replanning

        found.append(replanning.section(say))
    if "fleets" in parts and "ours" in installed:
        from tests.experiments.papers import fleets

        found.append(fleets.section(say))
    if "viewpoint" in parts and "ours" in installed:
        from tests.experiments.papers import viewpoint

        found.append(viewpoint.section(say))
    if "display" in parts:
        from tests.experiments.papers import display

        found.append(display.section(say))
    return found


def _films(
    parts: tuple[str, ...], drafts: list[Draft], conditions: tuple[str, ...], say: Callable[[str], None]
) -> list[Section]:
    """Run the parts of the framing missions that are asked for."""
    found: list[Section] = []
    if "framing" in parts:
        found.append(framing.section(drafts, conditions, say))
        found.append(tower.section(conditions, say))
        found.append(lenses.section(drafts, conditions, say))
        if "ours" in conditions:
            found.append(solvers.section(drafts, say))
    if "flown" in parts and "ours" in conditions and "ours" in plugins.names("replanners"):
        from tests.experiments.papers import flown

        found.append(flown.section(drafts, say))
    if "houses" in parts:
        found.append(houses.section(drafts, conditions, say))
    return found


def main() -> None:
    """Run, print and write."""
    parser = argparse.ArgumentParser(prog="python -m tests.experiments.papers", description=__doc__)
    parser.add_argument("--missions", type=int, default=MISSIONS, help="how many framing missions")
    parser.add_argument("--only", choices=PARTS, help="one part of the experiments")
    parser.add_argument("--write-page", action="store_true", help=f"put the tables into docs/{PAGE.name}")
    asked = parser.parse_args()
    began = time.perf_counter()

    def say(message: str) -> None:
        sys.stderr.write(f"{time.perf_counter() - began:6.1f} s  {message}\n")

    facts = [f"command: python -m tests.experiments.papers {' '.join(sys.argv[1:])}".rstrip(), *machine()]
    found = sections((asked.only,) if asked.only else PARTS, asked.missions, say)
    facts.append(f"took {time.perf_counter() - began:.0f} s")
    sys.stdout.write("\n".join([*facts, ""]) + "\n")
    for section in found:
        sys.stdout.write("\n".join(["", section.title.upper(), *section.facts, "", ""]))
        sys.stdout.write("\n".join(map(text, section.tables)))
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "report.html").write_text(html("The papers' experiments", facts, found), encoding="utf-8")
    if asked.write_page and not ORIGINALS:
        say(f"{PAGE.name} is left as it is: without the production missions it would lose a table")
    elif asked.write_page:
        body = "\n".join(f"- {fact}" for fact in facts) + "\n\n" + markdown(found)
        PAGE.write_text(page.filled(PAGE.read_text(encoding="utf-8"), body), encoding="utf-8")
    say(f"written: {(OUT / 'report.html').relative_to(ROOT)}")


if __name__ == "__main__":
    main()
