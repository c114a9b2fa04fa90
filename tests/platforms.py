"""``make platforms``: all that shotc and its plugins require has wheels everywhere, or is left out there.

uv resolves the requirements, those of development included, for each platform and version of Python from
wheels alone; it loads nothing but metadata. A requirement whose marker names a platform is an exception, and
``NO_WHEELS`` gives its reason. Exceptions are held to the truth: where the marker leaves a package out, the
index must have no wheel of it. A platform that the index has no wheels for at all is skipped with a word.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import Enum
from functools import partial
from pathlib import Path

from packaging.requirements import Requirement
from uv import find_uv_bin

ROOT = Path(__file__).parents[1]
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
NO_WHEELS = {
    "jt-pyrvo23d": "built for Linux x86-64 and Windows, up to Python 3.13; only tests use it",
    "mavsdk": "from version 4 on built for macOS 15 and later; only a test uses it, which is left out there",
    "rotorpy": "needs cvxopt, without wheels for new Pythons on macOS; only `--vehicle rotorpy` asks for it",
    "rerun-sdk": "its last wheels for Intel Macs are those of 0.26; a storyboard shows the plan there",
    "toppra": "built for Linux x86-64; Clarabel makes the same profiles elsewhere",
}
"""Packages that some platforms do without, and why they can."""
PROBE = "numpy"
"""A package of which every whole index has wheels for every platform."""
MACOS = "14.0"
"""The oldest macOS that is asked for: pyproj has no wheels for older ones on Apple's own processors."""
MOST_SAID = 200
"""Characters of a line on what is skipped: uv says the same of every platform."""
AT_ONCE = 8
"""Resolutions side by side: they wait for the index most of the time."""


@dataclass(frozen=True, slots=True)
class Platform:
    """A platform by uv's name for it, and what markers see there."""

    name: str
    system: str
    machine: str

    def takes(self, requirement: Requirement, python: str) -> bool:
        """Whether the marker of a requirement asks for it here."""
        seen = {"sys_platform": self.system, "platform_machine": self.machine, "python_version": python}
        return requirement.marker is None or requirement.marker.evaluate(seen)


PLATFORMS = (
    Platform("x86_64-unknown-linux-gnu", "linux", "x86_64"),
    Platform("aarch64-unknown-linux-gnu", "linux", "aarch64"),
    Platform("aarch64-apple-darwin", "darwin", "arm64"),
    Platform("x86_64-apple-darwin", "darwin", "x86_64"),
    Platform("x86_64-pc-windows-msvc", "win32", "AMD64"),
)


class Answer(Enum):
    """What an index has of some requirements."""

    WHEELS = "wheels"
    LACKING = "no wheels"
    SILENCE = "no answer"


@dataclass(frozen=True, slots=True)
class Question:
    """Whether requirements can be had from wheels; deep : with all that these require."""

    platform: Platform
    python: str
    requirements: tuple[str, ...]
    deep: bool = True

    def __str__(self) -> str:
        """Return where it is asked."""
        return f"{self.platform.name}, Python {self.python}"


@dataclass(frozen=True, slots=True)
class Reply:
    """An answer in one word, and in uv's words."""

    answer: Answer
    text: str = ""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Lines to print: what is wrong, what was not looked at, and what was."""

    faults: tuple[str, ...]
    skipped: tuple[str, ...]
    held: tuple[str, ...]


Ask = Callable[[Question], Reply]


def requirements(root: Path = ROOT) -> tuple[Requirement, ...]:
    """Return what shotc with all its extras and its plugins require of others."""
    lines: list[str] = []
    for file in (root / "pyproject.toml", *sorted(root.glob("plugins/*/pyproject.toml"))):
        project = tomllib.loads(file.read_text(encoding="utf-8"))["project"]
        lines += project["dependencies"]
        lines += [line for extra in project.get("optional-dependencies", {}).values() for line in extra]
    parsed = [Requirement(line) for line in dict.fromkeys(lines)]
    return tuple(r for r in parsed if r.name.partition("-")[0] != "shotc")


def exceptions(required: Sequence[Requirement]) -> tuple[Requirement, ...]:
    """Return the requirements whose markers name a platform."""
    return tuple(r for r in required if "platform" in str(r.marker))


def judge(required: Sequence[Requirement], reasons: Mapping[str, str], ask: Ask) -> Verdict:
    """Ask for every platform and Python, and for every exception where it is one."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        probes = list(pool.map(ask, [Question(p, PYTHONS[1], (PROBE,), deep=False) for p in PLATFORMS]))
        replies = dict(zip(PLATFORMS, probes, strict=True))
        there = [p for p in PLATFORMS if replies[p].answer is Answer.WHEELS]
        wholes = [Question(p, v, tuple(map(str, required))) for p in there for v in PYTHONS]
        alone = list(_where_left_out(there, exceptions(required)))
        asked = (*wholes, *alone)
        found = dict(zip(asked, pool.map(ask, asked), strict=True))
    faults = [
        *_unreasoned({r.name for r in exceptions(required)}, reasons),
        *(f"{q}: {found[q].text}" for q in wholes if found[q].answer is Answer.LACKING),
        *(
            f"{q}: {q.requirements[0]} has wheels, and its marker leaves it out"
            for q in alone
            if found[q].answer is Answer.WHEELS
        ),
    ]
    skipped = [f"{p.name}: {replies[p].text}" for p in PLATFORMS if p not in there]
    skipped += [f"{q}: {found[q].text}" for q in asked if found[q].answer is Answer.SILENCE]
    held = [str(q) for q in wholes if found[q].answer is Answer.WHEELS]
    return Verdict(tuple(faults), tuple(skipped), tuple(held))


def _unreasoned(marked: set[str], reasons: Mapping[str, str]) -> Iterator[str]:
    """Say where markers and reasons differ."""
    for name in sorted(marked ^ set(reasons)):
        yield f"{name}: " + ("no reason is stated" if name in marked else "a reason is stated, but no marker")


def _where_left_out(platforms: Sequence[Platform], marked: Sequence[Requirement]) -> Iterator[Question]:
    """Ask for each exception by itself, where its marker leaves it out."""
    for requirement in marked:
        alone = f"{requirement.name}{requirement.specifier}"
        for platform in platforms:
            for python in PYTHONS:
                if not platform.takes(requirement, python):
                    yield Question(platform, python, (alone,))


def ask_uv(uv: str, question: Question) -> Reply:
    """Resolve by a uv; raises RuntimeError where it fails for another reason than what the index has."""
    command = [uv, "pip", "compile", "--quiet", "--no-header", "--no-annotate", "-"]
    command += ["--only-binary", ":all:", "--no-python-downloads", "--python", sys.executable]
    command += ["--python-platform", question.platform.name, "--python-version", question.python]
    command += [] if question.deep else ["--no-deps"]
    # Nothing but the index counts: neither a lock nor the project around.
    done = subprocess.run(
        command,
        input="\n".join(question.requirements),
        env={**os.environ, "MACOSX_DEPLOYMENT_TARGET": MACOS},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 0:
        return Reply(Answer.WHEELS)
    text = " ".join(done.stderr.split())
    if "network was disabled" in text or "Failed to fetch" in text:
        return Reply(Answer.SILENCE, text)
    if "No solution found" in text:
        return Reply(Answer.LACKING, text)
    raise RuntimeError(text)


def main() -> int:
    """Print the verdict; 1 where something is wrong."""
    verdict = judge(requirements(), NO_WHEELS, partial(ask_uv, find_uv_bin()))
    for line in verdict.skipped:
        print(f"skipped: {line[:MOST_SAID]}")
    for line in verdict.faults:
        print(f"wrong: {line}")
    count = len(PLATFORMS) * len(PYTHONS)
    print(f"wheels of all requirements: on {len(verdict.held)} of {count} platforms and Pythons")
    for name, reason in NO_WHEELS.items():
        print(f"  but {name}: {reason}")
    return 1 if verdict.faults else 0


if __name__ == "__main__":
    sys.exit(main())
