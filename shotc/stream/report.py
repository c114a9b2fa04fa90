"""The send times of a flight in numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.stream.clock import PERIOD_S

LATE_S = 0.005
"""A setpoint sent more than this after its due time counts as late."""


@dataclass(frozen=True, slots=True)
class SendTimes:
    """The delays from the due time of a tick until the setpoints of all drones were sent, s.

    ticks : the number of ticks sent
    skipped : the number of ticks that passed before they could be sent
    late : the number of ticks sent later than LATE_S
    """

    ticks: int
    skipped: int
    late: int
    median: float
    p99: float
    worst: float


def send_times(delays: list[float], skipped: int) -> SendTimes:
    """Return the summary of all delays (s)."""
    if not delays:
        return SendTimes(0, skipped, 0, 0.0, 0.0, 0.0)
    all_of = np.array(delays)
    median, p99 = np.percentile(all_of, [50, 99]).tolist()
    late = int(np.count_nonzero(all_of > LATE_S))
    return SendTimes(len(delays), skipped, late, median, p99, float(all_of.max()))


def timing_summary(times: SendTimes) -> str:
    """Return the summary as one line of text."""
    numbers = (
        f"median {times.median * 1e3:.2f} ms, 99 % {times.p99 * 1e3:.2f} ms, worst {times.worst * 1e3:.2f} ms"
    )
    late = f"{times.late} of {times.ticks} later than {LATE_S * 1e3:.0f} ms"
    lost = f", {times.skipped} left out" if times.skipped else ""
    return f"sent every {PERIOD_S * 1e3:.0f} ms, after its moment: {numbers}; {late}{lost}"
