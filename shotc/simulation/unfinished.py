"""Runs that are done while others are not: kept, so that a simulation that is killed goes on from there.

One line of JSON a block of runs. A line that was not written to its end, or that belongs to another plan or
to other conditions, is passed over. The file goes when the simulation is finished.
"""

from __future__ import annotations

import json
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
from shotc.simulation.conditions import Conditions
from shotc.simulation.judge import Run
from shotc.simulation.runs import Block, Strays

NAME = "simulate.unfinished.jsonl"


_RUNS: TypeAdapter[tuple[Run, ...]] = TypeAdapter(tuple[Run, ...])


@dataclass(frozen=True, slots=True)
class Unfinished:
    """The blocks of one simulation that are done.

    path : of the file; key : of the plan and its conditions
    """

    path: Path
    key: str

    @staticmethod
    def of(folder: Path, ir: TrajectoryIR, conditions: Conditions) -> Unfinished:
        """Return what is kept in a folder of a plan in these conditions."""
        digest = sha256(f"{__version__} {ir.keyframes.mission.source_sha256} {asdict(conditions)}".encode())
        for track in ir.drones:
            digest.update(track.curve.breaks.tobytes() + track.curve.ctrl.tobytes())
        for fleet in ir.fleets:
            digest.update(fleet.breaks.tobytes() + fleet.coef.tobytes())
        return Unfinished(folder / NAME, digest.hexdigest())

    def done(self) -> tuple[Block, ...]:
        """Return the blocks that are kept; none where the file cannot be read."""
        try:
            lines = self.path.read_text(encoding="ascii").splitlines()
        except (OSError, ValueError):
            return ()
        return tuple(block for line in lines for block in self._block(line))

    def add(self, block: Block) -> None:
        """Keep a block; a disk that does not take it is no reason to stop."""
        document: dict[str, Any] = {"key": self.key, "runs": [asdict(run) for run in block.runs]}
        if block.strays is not None:
            document["strays"] = [block.strays.times.tolist(), block.strays.metres.tolist()]
        with suppress(OSError):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with self.path.open("a", encoding="ascii") as stream:
                stream.write(json.dumps(document) + "\n")

    def keeping(self, blocks: Iterator[Block], earlier: Sequence[Block]) -> Iterator[Block]:
        """Yield blocks as they come, and keep those that are not among the earlier ones."""
        for block in blocks:
            if not any(block is each for each in earlier):
                self.add(block)
            yield block

    def forget(self) -> None:
        """Remove the file."""
        with suppress(OSError):
            self.path.unlink(missing_ok=True)

    def _block(self, line: str) -> Iterator[Block]:
        with suppress(ValueError, KeyError, TypeError, ValidationError):
            document = json.loads(line)
            if document["key"] == self.key:
                strays = document.get("strays")
                runs = _RUNS.validate_python(document["runs"])
                yield Block(runs, None if strays is None else Strays(*map(np.array, strays)))
