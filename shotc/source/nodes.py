"""The tree of a YAML document: values with the offsets at which they stand."""

from typing import NamedTuple

from shotc.source.core_schema import ScalarValue


class Scalar(NamedTuple):
    """A value without parts; ``text`` is what it says before the schema turns it into a value."""

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

    size   : values inside, itself included, aliases followed
    height : collections inside each other, itself included, aliases followed
    """

    def __init__(self, start: int, end: int, entries: list[Entry] | None) -> None:
        self.start = start
        self.end = end
        self.items: list[Node] = []
        self.entries = entries
        self.size = 1
        self.height = 1


class Alias(NamedTuple):
    """A use of a value that is written elsewhere."""

    start: int
    end: int
    target: Scalar | Collection


Node = Scalar | Collection | Alias


def resolved(node: Node) -> Scalar | Collection:
    """Follow an alias to the value it stands for."""
    return node.target if isinstance(node, Alias) else node


def size_of(node: Node) -> int:
    """Return how many values a node stands for, aliases followed."""
    target = resolved(node)
    return target.size if isinstance(target, Collection) else 1


def height_of(node: Node) -> int:
    """Return how many collections stand inside each other in a node, aliases followed."""
    target = resolved(node)
    return target.height if isinstance(target, Collection) else 0
