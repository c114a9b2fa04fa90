"""The source of an IR element in the mission file: key paths, and the map from them to spans."""

from collections.abc import Mapping
from typing import NamedTuple

from shotc.diag.model import Label
from shotc.source.file import WHOLE_FILE, KeyPath, Span

__all__ = ["KeyPath", "OriginMap"]


class OriginMap(NamedTuple):
    """Spans of the keys and values of one mission by key path.

    file   : name of the mission in diagnostics
    keys   : span of the key that leads to a path (list items have none)
    values : span of the value at a path
    """

    file: str
    keys: Mapping[KeyPath, Span]
    values: Mapping[KeyPath, Span]

    def value(self, path: KeyPath, text: str = "") -> Label:
        """Return a label on the value at ``path``, or on the key of the nearest ancestor in the text."""
        if path in self.values:
            return Label(self.file, self.values[path], text)
        return self.key(path, text)

    def key(self, path: KeyPath, text: str = "") -> Label:
        """Return a label on the key at ``path``, or on its nearest ancestor in the text."""
        for end in range(len(path), 0, -1):
            span = self.keys.get(path[:end]) or self.values.get(path[:end])
            if span is not None:
                return Label(self.file, span, text)
        return Label(self.file, WHOLE_FILE, text)
