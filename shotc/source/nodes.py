"""The tree of a YAML document: values with their offsets."""

from typing import NamedTuple

from shotc.source.core_schema import ScalarValue


class Scalar(NamedTuple):
    """A value without parts; ``text`` is its text before the schema converts it."""

    start: int
    end: int
    value: ScalarValue
    text: str


class Entry(NamedTuple):
    """One key of a mapping and its value."""

    key: Scalar
    value: "Node"


class Collection:
    """A list (``entries`` is None) or a mapping.

    size   : number of values inside, with itself and with aliases resolved
    height : depth of nested collections, with itself and with aliases resolved
    """

    def __init__(self, start: int, end: int, entries: list[Entry] | None) -> None:
        self.start = start
        self.end = end
        self.items: list[Node] = []
        self.entries = entries
        self.size = 1
        self.height = 1


class Alias(NamedTuple):
    """A reference to a value that is written elsewhere."""

    start: int
    end: int
    target: Scalar | Collection


Node = Scalar | Collection | Alias


def resolved(node: Node) -> Scalar | Collection:
    """Return the value of an alias; any other node is returned as it is."""
    return node.target if isinstance(node, Alias) else node


def size_of(node: Node) -> int:
    """Return the number of values in a node, with aliases resolved."""
    target = resolved(node)
    return target.size if isinstance(target, Collection) else 1


def height_of(node: Node) -> int:
    """Return the depth of nested collections in a node, with aliases resolved."""
    target = resolved(node)
    return target.height if isinstance(target, Collection) else 0
