"""Size limits of a mission: far above the need of missions, far below a cost in time or memory."""

from __future__ import annotations

MAX_BYTES = 4 * 1024 * 1024
"""Most bytes of one file."""

MAX_TABLE_BYTES = 4_000_000
"""Most bytes of a file that a mission names: a path, a track, a drawing."""

MAX_LINKED_BYTES = 400_000_000
"""Most bytes of a scene, of footprints, or of a terrain: files that a plan links to."""

MAX_DEPTH = 64
"""Largest depth of nested lists and mappings, with aliases resolved."""

MAX_VALUES = 200_000
"""Most keys, scalars, lists and mappings as written."""

MAX_ALIAS_VALUES = 20_000
"""Most values that all aliases together expand to."""

MAX_DIRECTIVES = 16
"""Most lines that start with ``%``; the C parser needs quadratic time for them."""

MAX_FAULTS = 100
"""Most faults that are reported for one file."""

MAX_STRAY_CHARACTERS = 10
"""Most control characters that are reported one by one; a file with more is no text."""
