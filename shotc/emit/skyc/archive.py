"""The file itself: a ZIP archive with ``show.json`` in its root, the same bytes for the same show."""

from __future__ import annotations

import json
from collections.abc import Mapping
from io import BytesIO
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date that every archive bears: the earliest there is."""

READABLE = 0o644 << 16


def archive(content: Mapping[str, object]) -> bytes:
    """Return the archive of a show; what it refers to is inside ``content``, without references."""
    stream = BytesIO()
    entry = ZipInfo("show.json", EPOCH)
    entry.compress_type = ZIP_DEFLATED
    entry.create_system = 3  # not the system that it happens to be made on
    entry.external_attr = READABLE
    with ZipFile(stream, "w") as zipped:
        zipped.writestr(entry, json.dumps(content, separators=(",", ":"), allow_nan=False))
    return stream.getvalue()
