"""Replanners that fail, for a process that imports them by name."""

from __future__ import annotations

import os
import sys
from collections import deque
from dataclasses import replace
from itertools import repeat

import numpy as np

from shotc.plugin_api.replanner import Replan


class Failing:
    """A replanner and its planners; what : how it fails from the mission time ``since`` on, seconds."""

    name, summary, api = "failing", "fails", 1

    def __init__(self, what, since=-np.inf):
        self.what, self.since = what, since

    def chase(self, _problem):
        """Return itself, or raise."""
        if self.what == "raises at once":
            raise LookupError("no planner today")
        return self

    framing = chase

    def replan(self, situation, last):
        """Return the last plan from the situation's time on, or fail."""
        sys.stdout.write("a replanner prints, and no answer is spoiled\n")
        times = last.times - last.times[0] + situation.time
        plan = replace(last, times=times)
        if situation.time < self.since:
            return Replan(plan, "planned")
        if self.what == "hangs in C":
            deque(repeat(0), maxlen=0)
        if self.what == "dies":
            os._exit(3)
        if self.what == "raises":
            raise ZeroDivisionError("no plan\ntoday")
        return {
            "nan": Replan(replace(plan, places=last.places * np.nan), "planned"),
            "says no": Replan(None, "failed", "it does not know"),
            "garbage": 5,
            "short": Replan(replace(plan, places=last.places[1:]), "planned"),
            "lists": Replan(replace(plan, places=last.places.tolist()), "planned"),
            "late": Replan(replace(plan, times=times + 1.0), "planned"),
            "status": Replan(plan, "splendid"),
            "lambda": lambda: plan,
        }[self.what]


RAISES, RAISES_AT_ONCE, DIES = Failing("raises"), Failing("raises at once"), Failing("dies")
HANGS, HANGS_LATER = Failing("hangs in C"), Failing("hangs in C", since=10.0)
NAN, SAYS_NO, GARBAGE, SHORT = Failing("nan"), Failing("says no"), Failing("garbage"), Failing("short")
LISTS, LATE, STATUS, LAMBDA = Failing("lists"), Failing("late"), Failing("status"), Failing("lambda")
