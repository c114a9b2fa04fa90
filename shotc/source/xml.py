"""Parse any bytes as XML: expat calls a reader's handlers until the end, or the first fault of either."""

from typing import Any, NamedTuple, Protocol
from xml.parsers import expat


class StopParsing(Exception):
    """A reader raises it at its first fault, to stop expat."""


class XmlReader(Protocol):
    """The handlers that expat calls. `feed` sets ``parser`` before the first call.

    It knows the line number.
    """

    parser: Any

    def doctype(self, *declaration: Any) -> None:
        """Refuse a document type declaration: its entities could grow without bound."""

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Handle the start tag of an element."""

    def end(self, tag: str) -> None:
        """Handle the end tag of an element."""

    def text(self, data: str) -> None:
        """Handle text, or a part of a text."""


class NotXml(NamedTuple):
    """Why bytes are not XML: message, line and column from 1, and whether it is the encoding."""

    reason: str
    line: int = 1
    column: int = 1
    encoding: bool = False


def feed(data: bytes, reader: XmlReader) -> NotXml | None:
    """Read bytes as XML. Return None if expat read to the end, or if the reader stopped at its own fault."""
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = reader.doctype
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text
    parser.ProcessingInstructionHandler = getattr(reader, "instruction", None)
    reader.parser = parser
    try:
        parser.Parse(data, True)
    except StopParsing:
        return None
    except expat.ExpatError as error:
        return NotXml(expat.ErrorString(error.code), error.lineno, error.offset + 1)
    except (LookupError, ValueError) as error:  # expat asks Python for an unknown encoding
        return NotXml(str(error), encoding=True)
    return None
