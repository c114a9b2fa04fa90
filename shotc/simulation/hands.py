"""Who flies the runs of a simulation."""

from __future__ import annotations

Hands = int | str
"""So many processes of this machine at most, or the cluster whose scheduler is at an address."""


class NoCluster(Exception):
    """No scheduler answers at an address."""
