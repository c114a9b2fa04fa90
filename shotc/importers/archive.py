"""One member of a ZIP archive: any bytes in, its bytes or one fault out, and never more than is read."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from io import BytesIO
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile

MAGIC = b"PK"


def member(data: bytes, wanted: Callable[[str], bool], what: str, most: int) -> bytes | str:
    """Return the first member whose name is wanted, or why there is none.

    what : the member, in words; most : bytes of the archive, and of the member, beyond which nothing is read
    """
    if len(data) > most:
        return f"the file is larger than {most / 1e6:.0f} MB"
    try:
        with ZipFile(BytesIO(data)) as archive:
            found = next((i for i in archive.infolist() if wanted(i.filename)), None)
            if found is None:
                return f"it is an archive without {what}"
            # Others may ask for any amount of memory; and no more is unpacked than is read.
            if found.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
                return "its document is packed in a way that these files are not"
            with archive.open(found) as stream:
                inside = stream.read(most + 1)
    except (BadZipFile, OSError, EOFError, ValueError, RuntimeError, zlib.error, struct.error) as fault:
        return f"it is a broken archive: {fault}"
    return f"its document is larger than {most / 1e6:.0f} MB" if len(inside) > most else inside
