"""XML of any bytes: expat calls a reader's handlers until the end, the reader's first fault, or its own."""

from typing import Any, NamedTuple, Protocol
from xml.parsers import expat


class StopParsing(Exception):
    """A reader has found its first fault and leaves expat."""


class XmlReader(Protocol):
    """Expat's handlers; ``parser`` is set before the first is called and knows the line."""

    parser: Any

    def doctype(self, *declaration: Any) -> None:
        """Take a document type declaration: refuse it, for entities could grow without bound."""

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Take an element's beginning."""

    def end(self, tag: str) -> None:
        """Take an element's end."""

    def text(self, data: str) -> None:
        """Take text, or a part of one."""


class NotXml(NamedTuple):
    """Why bytes are no XML: expat's or Python's words, where from 1, and whether the encoding is to blame."""

    reason: str
    line: int = 1
    column: int = 1
    encoding: bool = False


def feed(data: bytes, reader: XmlReader) -> NotXml | None:
    """Read bytes as XML; return None where they were read to the end, or to the reader's own fault."""
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
    except (LookupError, ValueError) as error:  # what expat does not know it asks Python for
        return NotXml(str(error), encoding=True)
    return None
