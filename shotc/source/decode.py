"""Decode bytes to text: UTF-8 with or without a byte order mark. Everything else is a fault."""

from __future__ import annotations

import re
import unicodedata
from typing import NamedTuple

from shotc.source.fault import Fault
from shotc.source.file import WHOLE_FILE, SourceFile
from shotc.source.limits import MAX_BYTES, MAX_STRAY_CHARACTERS

# Characters that YAML 1.2 section 5.1 does not allow, and a byte order mark inside the text. One character
# class over all planes would take longer to compile than a mission takes to read.
_STRAY_LATIN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f]")
_STRAY_OTHERS = ("\ufeff", "\ufffe", "\uffff")
_REPLACEMENT = "\ufffd"
_WIDE_MARKS = (
    (b"\xff\xfe\x00\x00", "utf-32-le", "UTF-32"),
    (b"\x00\x00\xfe\xff", "utf-32-be", "UTF-32"),
    (b"\xff\xfe", "utf-16-le", "UTF-16"),
    (b"\xfe\xff", "utf-16-be", "UTF-16"),
)
_SAVE_AS = "save the file as UTF-8"


class DecodedFile(NamedTuple):
    """A source file, the faults of its bytes, and whether the parser should read it."""

    file: SourceFile
    faults: tuple[Fault, ...]
    readable: bool


def decode(data: bytes, name: str) -> DecodedFile:
    """Return the text, its faults, and whether the parser should read it.

    U+FFFD replaces each character that cannot be decoded or shown, one for one, so that positions stay right.
    """
    if len(data) > MAX_BYTES:
        return DecodedFile(SourceFile(name, ""), (_too_large(),), False)
    for mark, codec, title in _WIDE_MARKS:
        if data.startswith(mark):
            return _wide(data[len(mark) :], name, codec, title)
    if unmarked := _wide_without_mark(data[:4]):
        return _wide(data, name, unmarked, "UTF-16")
    data = data.removeprefix(b"\xef\xbb\xbf")
    faults: tuple[Fault, ...] = ()
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        text = data.decode("utf-8", "replace")
        faults = (_not_utf8(data, error, SourceFile(name, text)),)
    file = SourceFile(name, _without_stray(text))
    stray, is_text = _stray_characters(text, file)
    return DecodedFile(file, (*faults, *stray), is_text)


def _too_large() -> Fault:
    return Fault(
        "too-large",
        f"the file has more than {MAX_BYTES} bytes",
        WHOLE_FILE,
        help="keep long tracks and points in CSV files and name them in the mission",
    )


def _wide_without_mark(head: bytes) -> str | None:
    """Return the codec of ASCII text in UTF-16 without a byte order mark, found from its zero bytes."""
    if len(head) < 4 or 0 not in head:
        return None
    if head[1] == head[3] == 0 and head[0] and head[2]:
        return "utf-16-le"
    if head[0] == head[2] == 0 and head[1] and head[3]:
        return "utf-16-be"
    return None


def _wide(data: bytes, name: str, codec: str, title: str) -> DecodedFile:
    """Return the text of a file in a wider encoding, with the fault that refuses it."""
    text = _without_stray(data.decode(codec, "replace"))
    fault = Fault(
        "not-utf8", f"the file is written in {title}; missions are UTF-8", WHOLE_FILE, help=_SAVE_AS
    )
    return DecodedFile(SourceFile(name, text), (fault,), False)


def _not_utf8(data: bytes, error: UnicodeDecodeError, file: SourceFile) -> Fault:
    """Return the fault of the first byte that is not UTF-8, at the end of the text before it."""
    offset = len(data[: error.start].decode("utf-8"))
    byte = data[error.start]
    notes = [f"byte {error.start} of the file is 0x{byte:02x}"]
    if byte >= 0xA0:
        notes.append(f"in Latin-1 that byte would be '{chr(byte)}'")
    return Fault("not-utf8", "the file is not UTF-8 text", file.point(offset), tuple(notes), help=_SAVE_AS)


def _without_stray(text: str) -> str:
    for character in _STRAY_OTHERS:
        text = text.replace(character, _REPLACEMENT)
    return _STRAY_LATIN.sub(_REPLACEMENT, text)


def _stray_characters(text: str, file: SourceFile) -> tuple[list[Fault], bool]:
    """Report characters that YAML does not allow. If there are many, the file is not a text file."""
    offsets = [match.start() for match in _STRAY_LATIN.finditer(text)]
    for character in _STRAY_OTHERS:
        if character in text:
            offsets += [offset for offset, other in enumerate(text) if other == character]
    offsets.sort()
    if len(offsets) <= MAX_STRAY_CHARACTERS:
        return [_stray_character(text, offset, file) for offset in offsets], True
    first = offsets[0]
    fault = Fault(
        "control-character",
        "this is not a text file",
        file.point(first),
        (f"it holds {len(offsets)} control characters, the first is {_describe(text[first])}",),
        help="give a mission in YAML; plans and recordings are outputs",
    )
    return [fault], False


def _stray_character(text: str, offset: int, file: SourceFile) -> Fault:
    return Fault(
        "control-character",
        f"the character {_describe(text[offset])} cannot stand in a mission",
        file.point(offset),
        help="delete it",
    )


def _describe(character: str) -> str:
    name = unicodedata.name(character, "")
    code = f"U+{ord(character):04X}"
    return f"{code} ({name.lower()})" if name else code
