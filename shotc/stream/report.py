"""What came of a flight, in numbers: when setpoints were sent, and how the vehicles followed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.stream.clock import PERIOD_S

LATE_S = 0.005
"""A setpoint sent later than this after its moment counts as late."""


@dataclass(frozen=True, slots=True)
class SendTimes:
    """How long after their moments the setpoints of all drones were out, seconds.

    ticks : how many moments there were; skipped : how many passed before they could be served
    late : how many were served later than LATE_S
    """

    ticks: int
    skipped: int
    late: int
    median: float
    p99: float
    worst: float


def send_times(delays: list[float], skipped: int) -> SendTimes:
    """Return the summary of all delays."""
    if not delays:
        return SendTimes(0, skipped, 0, 0.0, 0.0, 0.0)
    all_of = np.array(delays)
    median, p99 = np.percentile(all_of, [50, 99]).tolist()
    late = int(np.count_nonzero(all_of > LATE_S))
    return SendTimes(len(delays), skipped, late, median, p99, float(all_of.max()))


def told(times: SendTimes) -> str:
    """Return the summary as a line."""
    numbers = (
        f"median {times.median * 1e3:.2f} ms, 99 % {times.p99 * 1e3:.2f} ms, worst {times.worst * 1e3:.2f} ms"
    )
    late = f"{times.late} of {times.ticks} later than {LATE_S * 1e3:.0f} ms"
    lost = f", {times.skipped} left out" if times.skipped else ""
    return f"sent every {PERIOD_S * 1e3:.0f} ms, after its moment: {numbers}; {late}{lost}"
