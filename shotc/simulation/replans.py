"""How the replans of a drone came out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Replans:
    """The number of replans of a drone in a run by result (``plugin_api.replanner``).

    failed : the replanner gave no plan that can be flown, or it hangs and is not asked again in this shot
    lost : the replanner was not asked, because the position of a target is unknown
    reason : of the last failure
    blind : the reason why the last target was lost
    late : what the drone was not back on its plan for, because no way there was clear; "" if it was back
    """

    planned: int = 0
    stalled: int = 0
    opened: int = 0
    failed: int = 0
    lost: int = 0
    lack: float = 0.0
    reason: str = ""
    blind: str = ""
    late: str = ""

    @property
    def requested(self) -> int:
        """The number of replans that the replanner was asked for, or would have been."""
        return self.planned + self.stalled + self.opened + self.failed
