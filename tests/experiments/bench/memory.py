"""The memory of a command and of all processes that it starts, together, at its largest."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

STEP = 0.01
"""Seconds between two looks."""

FIELD = re.compile(r"^(Rss|Private_Clean|Private_Dirty):\s+(\d+) kB", re.MULTILINE)


def start(command: Sequence[str], environment: Mapping[str, str]) -> int:
    """Start a command with its output thrown away, and return its process id."""
    return os.posix_spawn(
        command[0],
        command,
        environment,
        file_actions=[(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)],
    )


def check_status(command: Sequence[str], status: int) -> None:
    """End the program where a command failed."""
    if status:
        raise SystemExit(f"exit status {os.waitstatus_to_exitcode(status)}: {' '.join(command)}")


def peak_memory(command: Sequence[str], environment: Mapping[str, str]) -> float:
    """Run a command and return the most that its processes hold together, MiB (Linux).

    The largest process counts whole, the others with the pages that are theirs alone: they are forks, and
    what they share they share with it.
    """
    pid, largest = start(command, environment), 0.0
    while True:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            check_status(command, status)
            return largest
        found = [_memory(member) for member in _family(pid)]
        whole = max(found, key=lambda memory: memory.resident)
        together = whole.resident - whole.private + sum(memory.private for memory in found)
        largest = max(largest, together)
        time.sleep(STEP)


def _family(pid: int) -> Iterator[int]:
    """Yield a process and all its descendants."""
    yield pid
    for task in _listed(Path(f"/proc/{pid}/task")):
        try:
            children = (task / "children").read_text().split()
        except OSError:  # it has ended
            continue
        for child in children:
            yield from _family(int(child))


def _listed(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:  # it has ended
        return []


class _Memory(NamedTuple):
    """What a process holds, and what of it is its own alone, MiB."""

    resident: float
    private: float


def _memory(pid: int) -> _Memory:
    """Return the memory of a process; zeros where it has ended."""
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:
        return _Memory(0.0, 0.0)
    size = {name: int(kib) / 1024 for name, kib in FIELD.findall(text)}
    private = size.get("Private_Clean", 0.0) + size.get("Private_Dirty", 0.0)
    return _Memory(size.get("Rss", 0.0), private)
