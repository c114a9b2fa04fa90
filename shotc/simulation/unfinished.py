"""Progress file of a simulation: it records finished runs, so that a simulation that was killed can resume.

An entry is a block of runs. It is ignored if it belongs to another plan or to other conditions. The file is
deleted when the simulation is finished.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from shotc import __version__
from shotc.ir.trajectory import TrajectoryIR
from shotc.progress_file import ProgressFile
from shotc.simulation.conditions import Conditions
from shotc.simulation.judge import Run
from shotc.simulation.runs import RunBlock, Strays

NAME = "simulate.unfinished.jsonl"


_RUNS: TypeAdapter[tuple[Run, ...]] = TypeAdapter(tuple[Run, ...])


@dataclass(frozen=True, slots=True)
class Unfinished:
    """The finished blocks of one simulation.

    key : hash of the plan and its conditions
    """

    file: ProgressFile
    key: str

    @staticmethod
    def of(folder: Path, ir: TrajectoryIR, conditions: Conditions) -> Unfinished:
        """Return the record in a folder for a plan in these conditions."""
        digest = sha256(f"{__version__} {ir.keyframes.mission.source_sha256} {asdict(conditions)}".encode())
        for track in ir.drones:
            digest.update(track.curve.breaks.tobytes() + track.curve.ctrl.tobytes())
        for fleet in ir.fleets:
            digest.update(fleet.breaks.tobytes() + fleet.coef.tobytes())
        return Unfinished(ProgressFile(folder / NAME), digest.hexdigest())

    def done(self) -> tuple[RunBlock, ...]:
        """Return the recorded blocks."""
        return tuple(block for entry in self.file.entries() for block in self._block(entry))

    def add(self, block: RunBlock) -> None:
        """Record a block."""
        entry: dict[str, Any] = {"runs": [asdict(run) for run in block.runs]}
        if block.strays is not None:
            entry["strays"] = [block.strays.times.tolist(), block.strays.metres.tolist()]
        self.file.add(self.key, entry)

    def keeping(self, blocks: Iterator[RunBlock], earlier: Sequence[RunBlock]) -> Iterator[RunBlock]:
        """Yield blocks as they come, and record those that are not among the earlier ones."""
        for block in blocks:
            if not any(block is each for each in earlier):
                self.add(block)
            yield block

    def _block(self, entry: dict[str, Any]) -> Iterator[RunBlock]:
        if entry["key"] == self.key:
            with suppress(ValueError, KeyError, TypeError, ValidationError):
                strays = entry.get("strays")
                runs = _RUNS.validate_python(entry["runs"])
                yield RunBlock(runs, None if strays is None else Strays(*map(np.array, strays)))
