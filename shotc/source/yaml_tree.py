"""The hardened YAML reader: from any bytes to plain values, their spans, and faults."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from shotc.source.compose import compose
from shotc.source.decode import decode
from shotc.source.fault import Fault, capped
from shotc.source.file import WHOLE_FILE, KeyPath, Offsets, SourceFile, Span, Spans
from shotc.source.nodes import Alias, Collection, Node, Scalar


class Document(NamedTuple):
    """A mission as text and as plain values.

    file   : the text, as shown in diagnostics
    root   : dict, list, str, int, float, bool or None by YAML 1.2's core schema; None if nothing could be
        read.
             Repeated aliases share one object, so it is read-only.
    keys   : span of the key that leads to a path (list items have none)
    values : span of the value at a path; the root is ``()``. An empty value has an empty span after its
        colon.
             An alias has its own span; the values in it have the spans of the original.
    faults : of the text
    whole  : whether the text was read to its end, so that keys missing in ``root`` are missing in the file
    """

    file: SourceFile
    root: Any
    keys: Mapping[KeyPath, Span] = MappingProxyType({})
    values: Mapping[KeyPath, Span] = MappingProxyType({})
    faults: tuple[Fault, ...] = ()
    whole: bool = True


def parse(data: bytes, name: str) -> Document:
    """Read the bytes of a mission; never raise, for any bytes.

    name : of the file in messages
    """
    file, faults, readable = decode(data, name)
    if not readable:
        return Document(file, None, faults=_capped(list(faults)), whole=False)
    composed = compose(file)
    diagnostics = [*faults, *composed.faults]
    root = composed.root
    if composed.whole:
        diagnostics += _root_faults(root, file)
    if root is None:
        return Document(file, None, faults=_capped(diagnostics), whole=composed.whole)
    flat = _Flat()
    value = flat.add(root, ())
    keys, values = Spans(file, flat.keys), Spans(file, flat.values)
    return Document(file, value, keys, values, _capped(diagnostics), composed.whole)


_BEGIN = "begin with 'shotc: 1' and 'mission: NAME', or start from a template: shotc new"


def _root_faults(root: Node | None, file: SourceFile) -> list[Fault]:
    """Return the faults of a root that is no mapping; no root, or an explicit null, is an empty file."""
    if isinstance(root, Collection) and root.entries is not None:
        return []
    if root is None or (isinstance(root, Scalar) and root.value is None):
        return [Fault("empty-file", "the file holds no mission", WHOLE_FILE, help=_BEGIN)]
    shape = "a list" if isinstance(root, Collection) else "a single value"
    line, column = file.position(root.start)
    end = column + max(1, len(file.line(line).rstrip()) - column + 1)
    message = f"the file holds {shape}; a mission is a mapping of keys to values"
    return [Fault("not-a-mapping", message, Span(line, column, line, end), help=_BEGIN)]


def _capped(faults: list[Fault]) -> tuple[Fault, ...]:
    return capped(sorted(faults, key=lambda fault: fault.span), "the text")


class _Flat:
    """The tree as plain objects, with offsets by key path."""

    def __init__(self) -> None:
        self.keys: dict[KeyPath, Offsets] = {}
        self.values: dict[KeyPath, Offsets] = {}

    def add(self, node: Node, path: KeyPath) -> Any:
        """Return the value of a node and store its offsets; the depth limit bounds the recursion."""
        self.values[path] = (node.start, node.end)
        if isinstance(node, Alias):
            node = node.target
        if isinstance(node, Scalar):
            return node.value
        return self._parts(node, path)

    def _parts(self, node: Collection, path: KeyPath) -> Any:
        if node.entries is None:
            return [self.add(item, (*path, i)) for i, item in enumerate(node.items)]
        content = {}
        for entry in node.entries:
            key = entry.key.text
            inner = (*path, key)
            self.keys[inner] = (entry.key.start, entry.key.end)
            content[key] = self.add(entry.value, inner)
        return content
