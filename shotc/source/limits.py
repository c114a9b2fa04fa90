"""How much a mission may hold; all are far above what missions need and far below what hurts."""

from __future__ import annotations

MAX_BYTES = 4 * 1024 * 1024
"""Bytes of one file."""

MAX_TABLE_BYTES = 4_000_000
"""Bytes of a file that a mission names: a path, a track, a drawing."""

MAX_LINKED_BYTES = 400_000_000
"""Bytes of a scene, of footprints, or of a terrain: files that a plan links to."""

MAX_DEPTH = 64
"""Lists and mappings inside each other, aliases followed."""

MAX_VALUES = 200_000
"""Keys, scalars, lists and mappings as written."""

MAX_ALIAS_VALUES = 20_000
"""Values that all aliases together stand for."""

MAX_DIRECTIVES = 16
"""Lines that begin with ``%``; the C parser takes quadratic time over them."""

MAX_FAULTS = 100
"""Faults reported for one file."""

MAX_STRAY_CHARACTERS = 10
"""Control characters reported one by one; beyond that the file is no text."""
