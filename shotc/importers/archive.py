"""Read members of a ZIP archive, up to a size limit. Any bytes give a member or one fault."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from posixpath import normpath
from typing import NamedTuple
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from shotc.importers.notes import plain
from shotc.importers.words import CUT_IN_TWO, EXPORT_AGAIN

MAGIC = b"PK"
BROKEN = (BadZipFile, OSError, EOFError, ValueError, RuntimeError, zlib.error, struct.error)
"""Exceptions that `zipfile` raises for bytes that are not an archive."""
OTHER_PACKING = "is packed in a way that these files are not"
PACK = "pack it again with the method `deflate`, as most programs do"


class ArchiveFault(NamedTuple):
    """Why an archive has no such member, and what remedies that."""

    message: str
    help: str


def member(data: bytes, matches: Callable[[str], bool], what: str, most: int) -> bytes | ArchiveFault:
    """Return the first member whose name is ``matches``, or a text that says why there is none.

    what : description of the member for that text
    most : largest size of the archive, and of the member, bytes
    """
    if len(data) > most:
        return ArchiveFault(f"the file is larger than {most / 1e6:.0f} MB", CUT_IN_TWO)
    try:
        with ZipFile(BytesIO(data)) as archive:
            entry = next((i for i in archive.infolist() if matches(i.filename)), None)
            if entry is None:
                return ArchiveFault(f"it is an archive without {what}", f"put {what} into it")
            # Other methods may need any amount of memory. These unpack no more than is read.
            if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
                return ArchiveFault(f"its document {OTHER_PACKING}", PACK)
            with archive.open(entry) as stream:
                inside = stream.read(most + 1)
    except BROKEN as fault:
        return ArchiveFault(f"it is a broken archive: {fault}", EXPORT_AGAIN)
    large = ArchiveFault(f"its document is larger than {most / 1e6:.0f} MB", CUT_IN_TWO)
    return large if len(inside) > most else inside


class Archive:
    """An archive that is opened once, and whose members are read by their names.

    most : largest size of the archive, and of a member, bytes
    all  : largest size of all reads together, bytes; a member counts each time that it is read
    """

    def __init__(self, data: bytes, most: int, all: int) -> None:
        self._most, self._left = most, all
        self._zip: ZipFile | None = None
        self._members: dict[str, ZipInfo] = {}
        self.fault: ArchiveFault | None = None
        if len(data) > most:
            self.fault = ArchiveFault(f"the file is larger than {most / 1e6:.0f} MB", CUT_IN_TWO)
            return
        try:
            self._zip = ZipFile(BytesIO(data))
            self._members = {normpath(each.filename): each for each in reversed(self._zip.infolist())}
        except BROKEN as fault:
            self.fault = _broken(fault)

    def member(self, name: str) -> bytes | ArchiveFault:
        """Return the member with this name, or a text that says why there is none."""
        if self.fault is not None or self._zip is None:
            return self.fault or ArchiveFault("it is no archive", EXPORT_AGAIN)
        entry = self._members.get(normpath(name))
        if entry is None:
            what = f"`{plain(name, 60)}`"
            return ArchiveFault(f"it is an archive without {what}", f"put {what} into it")
        if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
            return ArchiveFault(f"`{plain(name, 60)}` {OTHER_PACKING}", PACK)
        try:
            with self._zip.open(entry) as stream:
                inside = stream.read(min(self._most, self._left) + 1)
        except BROKEN as fault:
            return _broken(fault)
        self._left -= len(inside)
        if len(inside) > self._most or self._left < 0:
            return ArchiveFault(f"its document is larger than {self._most / 1e6:.0f} MB", CUT_IN_TWO)
        return inside


def members(
    data: bytes, matches: Callable[[str], bool], most: int
) -> Iterator[tuple[str, bytes] | ArchiveFault]:
    """Yield (name, bytes) of each member whose name is ``matches``; after a fault, a text as the last item.

    most : largest size of the archive, and of all members together, bytes
    """
    if len(data) > most:
        yield ArchiveFault(f"the file is larger than {most / 1e6:.0f} MB", CUT_IN_TWO)
        return
    left = most
    try:
        with ZipFile(BytesIO(data)) as archive:
            for entry in archive.infolist():
                if not matches(entry.filename):
                    continue
                if entry.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
                    yield ArchiveFault(f"`{plain(entry.filename, 60)}` {OTHER_PACKING}", PACK)
                    return
                with archive.open(entry) as stream:
                    inside = stream.read(left + 1)
                left -= len(inside)
                if left < 0:
                    yield ArchiveFault(f"what is in it is larger than {most / 1e6:.0f} MB", CUT_IN_TWO)
                    return
                yield entry.filename, inside
    except BROKEN as fault:
        yield _broken(fault)


def _broken(fault: BaseException) -> ArchiveFault:
    return ArchiveFault(f"it is a broken archive: {plain(str(fault), 80)}", EXPORT_AGAIN)
