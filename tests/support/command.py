"""Runs of the command line, inside this process and in its own, and what a user reads from them."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

SHOTC = (sys.executable, "-m", "shotc")
PLAN = ("plan", "--refiner", "none")
"""Most tests are of what no refiner touches."""
SMALL = """\
shotc: 1
mission: small
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - {id: wide, kind: static, drone: cam1, target: tower, timing: {duration: 2},
     at: [0, -50, 15], look_at: tower}
output: {rate: 20, emit: [csv]}
"""
"""A mission that is planned in no time."""
_HEAD = re.compile(r"^(error|warning)\[([A-Z]\d{3})\]: (.*)$")
_PLACE = re.compile(r"^ *--> (.*):(\d+):(\d+)$")
_SOURCE = re.compile(r"^ *(\d+) \| ")
_MARKS = re.compile(r"^ *\| +[\^-]")


@dataclass(frozen=True)
class Result:
    """How a command ended, and its streams."""

    code: int
    out: str
    err: str

    @property
    def reports(self) -> list[Report]:
        """The diagnostics on the error stream."""
        lines = self.err.splitlines()
        heads = [i for i, line in enumerate(lines) if _HEAD.match(line)]
        return [_report(lines[a:b]) for a, b in pairwise([*heads, len(lines)])]

    @property
    def errors(self) -> list[Report]:
        return [report for report in self.reports if report.severity == "error"]


@dataclass(frozen=True)
class Report:
    """One diagnostic as it is printed.

    line : of its primary label; labelled : all lines of the source with a mark under them
    """

    severity: str
    code: str
    message: str
    line: int
    labelled: tuple[int, ...]
    notes: tuple[str, ...]
    help: str

    @property
    def text(self) -> str:
        return "\n".join([self.message, *self.notes, self.help])


def _report(lines: Sequence[str]) -> Report:
    head = _HEAD.match(lines[0])
    assert head is not None
    place = _PLACE.match(lines[1])
    labelled, at = [], 0
    for line in lines[1:]:
        if source := _SOURCE.match(line):
            at = int(source[1])
        elif _MARKS.match(line) and at not in labelled:
            labelled.append(at)
    told = [line.split(": ", 1)[1] for line in lines if line.lstrip().startswith("= note: ")]
    helped = [line.split(": ", 1)[1] for line in lines if line.lstrip().startswith("= help: ")]
    line = int(place[2]) if place else 0
    return Report(head[1], head[2], head[3], line, tuple(labelled), tuple(told), " ".join(helped))


def run(
    *arguments: str | Path, folder: Path, stdin: bytes = b"", env: Mapping[str, str] | None = None
) -> Result:
    """Run the command in a process of its own."""
    done = subprocess.run(
        [*SHOTC, *map(str, arguments)],
        cwd=folder,
        input=stdin,
        env=environment(env or {}),
        capture_output=True,
        check=False,
        timeout=120,
        start_new_session=True,
    )
    return Result(done.returncode, done.stdout.decode(), done.stderr.decode())


def environment(more: Mapping[str, str]) -> dict[str, str]:
    """Return an environment in which nothing of the caller's changes what the command prints."""
    noisy = ("NO_COLOR", "FORCE_COLOR", "GITHUB_ACTIONS", "SHOTC_DEBUG", "PYTHONPATH")
    plain = {name: value for name, value in os.environ.items() if name not in noisy}
    return plain | {"TERM": "xterm", "COLUMNS": "100"} | dict(more)
