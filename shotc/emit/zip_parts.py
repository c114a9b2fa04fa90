"""ZIP archives with reproducible bytes, written member by member."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of all members, the earliest that ZIP allows."""

READABLE_MODE = 0o644 << 16


def entry(name: str, method: int = ZIP_DEFLATED) -> ZipInfo:
    """Return the header of a member, independent of time and machine."""
    info = ZipInfo(name, EPOCH)
    info.compress_type = method
    info.create_system = 3  # Unix, whatever the machine is
    info.external_attr = READABLE_MODE
    return info


class _Pipe:
    """The output of an archive: it holds only the bytes not yet taken, and is not seekable."""

    def __init__(self) -> None:
        self._held = bytearray()

    def write(self, data: bytes) -> int:
        self._held += data
        return len(data)

    def flush(self) -> None:
        pass

    def taken(self) -> bytes:
        data = bytes(self._held)
        self._held.clear()
        return data


def archive_parts(members: Iterable[tuple[str, bytes]]) -> Iterator[bytes]:
    """Yield the bytes of an archive, member by member.

    members : their names and contents
    """
    pipe = _Pipe()
    with ZipFile(pipe, "w") as archive:  # type: ignore[call-overload]  # it needs no more than write and flush
        for name, data in members:
            archive.writestr(entry(name), data)
            yield pipe.taken()
    yield pipe.taken()
