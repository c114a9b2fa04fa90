"""Adds targets to a mission's text by edits at offsets, so that comments and layout stay."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from math import ceil, floor
from typing import Any, NamedTuple

from shotc.geom.camera import ScreenBox
from shotc.identify.cylinders import Upright
from shotc.source.file import KeyPath, SourceFile, Span
from shotc.source.yaml_tree import Document, parse

TARGETS: KeyPath = ("targets",)
_PROPERTIES = re.compile(r"(?:[&!]\S*\s+)+")
_BEFORE_DRONES = ("drones", "fleets", "rules", "shots", "output")
CM_PER_M = 100.0


class Named(NamedTuple):
    """What is added to a keyframe: its target, and a guessed box; None if the keyframe has a box."""

    path: KeyPath
    target: str
    box: ScreenBox | None = None


class _Edit(NamedTuple):
    """Text to insert at an offset."""

    at: int
    text: str


class NotEditable(Exception):
    """Keys cannot be inserted into the mapping at ``path``, as it is written."""

    def __init__(self, path: KeyPath) -> None:
        super().__init__(path)
        self.path = path


def rewritten(data: bytes, name: str, targets: Mapping[str, Upright], named: Sequence[Named]) -> bytes:
    """Return a mission's bytes with targets added, and keyframes that name them.

    Raises NotEditable if the keyframes or the targets are written elsewhere, for example by an alias.

    data : a mission without faults
    name : its displayed name
    """
    document = parse(data, name)
    text = _Text(document)
    entries = {key: _entry(upright) for key, upright in targets.items()}
    edits = [*text.added(TARGETS, entries)] if entries else []
    for keyframe in named:
        edits += text.given(keyframe.path, _keys(keyframe))
    new_text = _applied(document.file.text, edits)
    mark = b"\xef\xbb\xbf" if data.startswith(b"\xef\xbb\xbf") else b""
    result = mark + new_text.encode()
    _compare(document, parse(result, name), targets, named)
    return result


def _entry(upright: Upright) -> str:
    bottom, top = floor(upright.bottom * CM_PER_M) / CM_PER_M, ceil(upright.top * CM_PER_M) / CM_PER_M
    x, y = (round(c, 2) for c in upright.centre)
    # Rounding up keeps the points inside the cylinder.
    radius = ceil(upright.radius * CM_PER_M + 1.0) / CM_PER_M
    at = ", ".join(_number(c) for c in (x, y, 0.5 * (bottom + top)))
    return f"{{at: [{at}], radius: {_number(radius)}, height: {_number(top - bottom)}}}"


def _number(value: float) -> str:
    return f"{round(value, 3) + 0.0:g}" if abs(value) < 1e5 else f"{value:.3f}"


def _keys(named: Named) -> dict[str, str]:
    keys = {"target": named.target}
    if named.box is not None:
        b = named.box
        keys["box"] = f"[{', '.join(f'{c:.3f}' for c in (b.u_min, b.v_min, b.u_max, b.v_max))}]"
    return keys


def _applied(text: str, edits: Sequence[_Edit]) -> str:
    for edit in sorted(dict.fromkeys(edits), key=lambda e: e.at, reverse=True):
        text = text[: edit.at] + edit.text + text[edit.at :]
    return text


class _Text:
    """A mission's text, with the positions of its keys and values."""

    def __init__(self, document: Document) -> None:
        self.file: SourceFile = document.file
        self.text = document.file.text
        self.root = document.root
        self.keys, self.values = document.keys, document.values
        self.end = "\r\n" if "\r\n" in self.text else "\n"
        self._lines = [0]
        for match in re.finditer(r"\r\n|\r|\n", self.text):
            self._lines.append(match.end())

    def given(self, path: KeyPath, keys: Mapping[str, str]) -> Iterator[_Edit]:
        """Yield the edits that insert keys into an existing, non-empty mapping; raise NotEditable if it is
        not written here.
        """
        inside = [key for key in self.keys if key[:-1] == path]
        if not inside or self._offset(self.keys[inside[0]]) < self._offset(self.values[path]):
            raise NotEditable(path)
        if self._is_flow(path):
            last = max(self._offset(self.values[key], end=True) for key in inside)
            yield _Edit(last, "".join(f", {key}: {value}" for key, value in keys.items()))
            return
        plain = [key for key in inside if self._ends_its_line(key)]
        if not plain:
            raise NotEditable(path)
        beside = (*path, "box") if (*path, "box") in plain else plain[-1]
        indent = " " * (self.keys[beside].column - 1)
        at = self._line_end(self._offset(self.values[beside], end=True))
        yield _Edit(at, "".join(f"{self.end}{indent}{key}: {value}" for key, value in keys.items()))

    def added(self, path: KeyPath, entries: Mapping[str, str]) -> Iterator[_Edit]:
        """Yield the edits that insert entries into a top-level mapping, which may not exist yet.

        Raises NotEditable if it is not written here.
        """
        if path not in self.keys:
            yield self._new_section(str(path[0]), entries)
            return
        inside = [key for key in self.keys if key[:-1] == path]
        if self._is_flow(path):
            first = self._after_properties(path) + 1
            rest = ", " if inside else ""
            yield _Edit(first, ", ".join(f"{key}: {value}" for key, value in entries.items()) + rest)
            return
        if not inside or self._offset(self.keys[inside[0]]) < self._offset(self.values[path]):
            raise NotEditable(path)
        indent = " " * (self.keys[inside[0]].column - 1)
        at = self._line_end(self._offset(self.keys[path], end=True))
        yield _Edit(at, "".join(f"{self.end}{indent}{key}: {value}" for key, value in entries.items()))

    def _new_section(self, name: str, entries: Mapping[str, str]) -> _Edit:
        if self._is_flow(()):
            first = self._after_properties(()) + 1
            inside = ", ".join(f"{key}: {value}" for key, value in entries.items())
            return _Edit(first, f"{name}: {{{inside}}}, ")
        follows = next((key,) for key in _BEFORE_DRONES if (key,) in self.keys)
        line = self.keys[follows].line
        # Comments directly above a key belong to it.
        while line > 1 and self.file.line(line - 1).startswith("#"):
            line -= 1
        indent = " " * (self.keys[follows].column - 1)
        lines = [f"{indent}{name}:", *(f"{indent}  {key}: {value}" for key, value in entries.items())]
        return _Edit(self._lines[line - 1], "".join(f"{each}{self.end}" for each in lines))

    def _is_flow(self, path: KeyPath) -> bool:
        return self.text[self._after_properties(path)] in "{["

    def _after_properties(self, path: KeyPath) -> int:
        """Return the offset at which a value begins, after its anchor and tag."""
        start = self._offset(self.values[path])
        properties = _PROPERTIES.match(self.text, start)
        return start if properties is None else properties.end()

    def _ends_its_line(self, path: KeyPath) -> bool:
        """Return whether a value is followed by nothing else of the mission on its last line."""
        value = self.values[path]
        parts = [key for key in self.values if key[:-1] == path]
        if parts and not self._is_flow(path):
            return False
        start = self._after_properties(path)
        return self.text[start : start + 1] not in ("|", ">") and value.end_line >= value.line

    def _line_end(self, offset: int) -> int:
        line = self.file.position(offset)[0]
        return self._lines[line - 1] + len(self.file.line(line))

    def _offset(self, span: Span, *, end: bool = False) -> int:
        line, column = (span.end_line, span.end_column) if end else (span.line, span.column)
        return self._lines[line - 1] + column - 1


def _compare(
    before: Document, after: Document, targets: Mapping[str, Upright], named: Sequence[Named]
) -> None:
    """Raise NotEditable if the new text's content differs from the old one's with the additions."""
    expected = _copied(before.root)
    if targets:
        held = after.root.get("targets", {}) if isinstance(after.root, dict) else {}
        expected["targets"] = {**expected.get("targets", {}), **{key: held.get(key) for key in targets}}
    for keyframe in named:
        mapping: Any = expected
        for key in keyframe.path:
            mapping = mapping[key]
        mapping["target"] = keyframe.target
        if keyframe.box is not None:
            mapping["box"] = [float(c) for c in _keys(keyframe)["box"][1:-1].split(",")]
    if after.faults or after.root != expected:
        raise NotEditable(named[0].path if named else TARGETS)


def _copied(root: Any) -> Any:
    """Return a copy in which no two places share one object, as aliases do."""
    if isinstance(root, dict):
        return {key: _copied(value) for key, value in root.items()}
    return [_copied(item) for item in root] if isinstance(root, list) else deepcopy(root)
