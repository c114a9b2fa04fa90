"""The two timelines of a recording: mission time, and mission time that begins at the first filmed frame.

A viewer opens a recording at the beginning of its timeline, and no layout can change that. The second
timeline therefore makes it open at the first filmed frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import rerun as rr

MISSION, FILMED = "t", "filmed"


@dataclass(frozen=True, slots=True)
class Clocked:
    """A stream that logs on both timelines.

    start : seconds; on FILMED, earlier rows stand at this time
    """

    stream: Any
    start: float

    def log(self, entity: str, *values: Any, **more: Any) -> None:
        """Log with the stream."""
        self.stream.log(entity, *values, **more)

    def set_time(self, timeline: str, *, duration: float) -> None:
        """Set the time of the following logs, seconds."""
        self.stream.set_time(timeline, duration=duration)
        if timeline == MISSION:
            self.stream.set_time(FILMED, duration=max(duration, self.start))

    def send_columns(self, entity: str, *, indexes: list[Any], columns: Any) -> None:
        """Send columns with the stream."""
        both = [each for index in indexes for each in self._both(index)]
        self.stream.send_columns(entity, indexes=both, columns=columns)

    def _both(self, index: Any) -> list[Any]:
        if index.timeline_name() != MISSION:
            return [index]
        t = np.asarray(index.as_arrow_array().cast("int64"), dtype=np.int64)
        filmed = np.maximum(t, round(self.start * 1e9)).astype("timedelta64[ns]")
        return [index, rr.TimeColumn(FILMED, duration=filmed)]
