"""Members of a ZIP archive: any bytes in, theirs or one fault out, and never more than is read."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from posixpath import normpath
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from shotc.importers.notes import plain

MAGIC = b"PK"
BROKEN = (BadZipFile, OSError, EOFError, ValueError, RuntimeError, zlib.error, struct.error)
"""What the reader of archives raises for bytes that are none."""
OTHER_PACKING = "is packed in a way that these files are not"


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
                return f"its document {OTHER_PACKING}"
            with archive.open(found) as stream:
                inside = stream.read(most + 1)
    except BROKEN as fault:
        return f"it is a broken archive: {fault}"
    return f"its document is larger than {most / 1e6:.0f} MB" if len(inside) > most else inside


class Archive:
    """An archive of which many members are read by their names, and which is opened once.

    most : bytes of the archive, and of a member; all : of all that is read, each time that it is
    """

    def __init__(self, data: bytes, most: int, all: int) -> None:
        self._most, self._left = most, all
        self._zip: ZipFile | None = None
        self._members: dict[str, ZipInfo] = {}
        self.fault = f"the file is larger than {most / 1e6:.0f} MB" if len(data) > most else ""
        if self.fault:
            return
        try:
            self._zip = ZipFile(BytesIO(data))
            self._members = {normpath(each.filename): each for each in reversed(self._zip.infolist())}
        except BROKEN as fault:
            self.fault = f"it is a broken archive: {plain(str(fault), 80)}"

    def member(self, name: str) -> bytes | str:
        """Return the member of a name, or why there is none."""
        if self.fault or self._zip is None:
            return self.fault
        found = self._members.get(normpath(name))
        if found is None:
            return f"it is an archive without `{plain(name, 60)}`"
        if found.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
            return f"`{plain(name, 60)}` {OTHER_PACKING}"
        try:
            with self._zip.open(found) as stream:
                inside = stream.read(min(self._most, self._left) + 1)
        except BROKEN as fault:
            return f"it is a broken archive: {plain(str(fault), 80)}"
        self._left -= len(inside)
        if len(inside) > self._most or self._left < 0:
            return f"its document is larger than {self._most / 1e6:.0f} MB"
        return inside


def members(data: bytes, wanted: Callable[[str], bool], most: int) -> Iterator[tuple[str, bytes] | str]:
    """Yield the name and the bytes of every member whose name is wanted, or last why there are no more.

    most : bytes of the archive, and of all members together, beyond which nothing is read
    """
    if len(data) > most:
        yield f"the file is larger than {most / 1e6:.0f} MB"
        return
    left = most
    try:
        with ZipFile(BytesIO(data)) as archive:
            for found in archive.infolist():
                if not wanted(found.filename):
                    continue
                if found.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
                    yield f"`{plain(found.filename, 60)}` {OTHER_PACKING}"
                    return
                with archive.open(found) as stream:
                    inside = stream.read(left + 1)
                left -= len(inside)
                if left < 0:
                    yield f"what is in it is larger than {most / 1e6:.0f} MB"
                    return
                yield found.filename, inside
    except BROKEN as fault:
        yield f"it is a broken archive: {plain(str(fault), 80)}"
