"""<mission>.skyc: the show of all fleets in the format of Skybrush."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.emit.base import Artifact, Emission
from shotc.filenames import file_name
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.skyc.archive import archive, left_out, no_origin, song_of, too_large
from shotc.show.emit.skyc.show import MOST_DRONES, show_of


@dataclass(frozen=True, slots=True)
class SkycEmitter:
    """Writes one show file for all fleets; the same plan gives the same bytes."""

    name: ClassVar[str] = "skyc"
    summary: ClassVar[str] = "<mission>.skyc: the flights and lights of fleets, for Skybrush"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the show file; no file without fleets, or with too many drones."""
        mission = plan.trajectory.keyframes.mission
        count = sum(len(flight.coef) for flight in plan.trajectory.fleets)
        if count == 0:
            return Emission(
                (), notes=("no .skyc is written: it holds the show of a fleet, and the mission has none",)
            )
        if count > MOST_DRONES:
            return Emission((), (too_large(mission, count),))
        show = show_of(plan)
        faults = [left_out(mission, zone) for zone in show.left_out]
        if mission.origin is None:
            faults.append(no_origin(mission))
        song = song_of(mission)
        faults += song.faults
        content = show.content if song.media is None else {**show.content, "media": song.media}
        file = Artifact(f"{file_name(mission.name)}.skyc", archive(content, song.assets))
        note = f"{file.name}: no drone is more than {show.error * 1e3:.2f} mm from its place in the plan"
        return Emission((file,), tuple(faults), (note,))


EMITTER = SkycEmitter()
