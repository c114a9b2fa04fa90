"""Build a tree from the events of the YAML parser, in one lazy pass with caps on size and depth.

``yaml.compose`` is not safe for untrusted text: it recurses in C, so deep input kills the process, and
aliases share nodes, so an alias bomb expands later. This pass checks every event against the caps before
it builds anything from it.
"""

import re
from difflib import get_close_matches
from typing import Any, NamedTuple

import yaml

from shotc.source.core_schema import CORE_TAG, resolve, resolve_tagged
from shotc.source.fault import Fault, FaultKind, shorten
from shotc.source.file import SourceFile
from shotc.source.limits import MAX_ALIAS_VALUES, MAX_DEPTH, MAX_DIRECTIVES, MAX_VALUES
from shotc.source.nodes import Alias, Collection, Entry, Node, Scalar, height_of, size_of
from shotc.source.syntax import Complaint, explain

_DIRECTIVE = re.compile(r"^%", re.MULTILINE)
_LOADER = getattr(yaml, "CLoader", yaml.Loader)  # the parser in C, wherever PyYAML has it
_TAG = r"[^ \t\r\n,\]}]*"


class ComposedDocument(NamedTuple):
    """The first document of a text.

    root  : its tree, as far as it was read; None for an empty text
    whole : whether it was read to its end
    """

    root: Node | None
    faults: list[Fault]
    whole: bool


def compose(file: SourceFile) -> ComposedDocument:
    """Return the tree of the first document in ``file`` and the faults on the way."""
    composer = _Composer(file)
    if fault := _too_many_directives(file):
        return ComposedDocument(None, [fault], False)
    try:
        for event in yaml.parse(file.text, Loader=_LOADER):
            composer.take(event)
    except _StopReading:
        pass
    except yaml.MarkedYAMLError as error:
        composer.fault(composer.explained(error))
        composer.whole = False
    except yaml.reader.ReaderError as error:
        start = min(max(error.position, 0), len(file.text))
        composer.fault(Fault("syntax", str(error.reason), file.point(start)))
        composer.whole = False
    composer.close_all()
    return ComposedDocument(composer.root, composer.faults, composer.whole)


def _too_many_directives(file: SourceFile) -> Fault | None:
    starts = [match.start() for match in _DIRECTIVE.finditer(file.text)]
    if len(starts) <= MAX_DIRECTIVES:
        return None
    return Fault(
        "syntax",
        f"the file has {len(starts)} lines that begin with '%'; a mission needs none",
        file.point(starts[0]),
        help="delete the lines that begin with '%'",
    )


class _StopReading(Exception):
    """Ends the pass over the events: a cap is reached or a second document begins."""


class _Open:
    """A collection whose end event has not come yet. In a mapping, ``key`` may still wait for its value."""

    def __init__(self, node: Collection, anchor: str | None, flow: bool) -> None:
        self.node = node
        self.anchor = anchor
        self.flow = flow
        self.key: Scalar | None = None
        self.has_key = False
        self.seen: dict[str, Scalar] = {}


class _Composer:
    """Builds the tree event by event; holds the faults found so far."""

    def __init__(self, file: SourceFile) -> None:
        self.file = file
        self.root: Node | None = None
        self.faults: list[Fault] = []
        self.whole = True
        self.stack: list[_Open] = []
        self.anchors: dict[str, Scalar | Collection] = {}
        self.documents = 0
        self.values = 0
        self.alias_values = 0

    def take(self, event: Any) -> None:
        """Check one parser event against the caps and add it to the tree."""
        start, end = event.start_mark.index, event.end_mark.index
        match event:
            case yaml.ScalarEvent():
                self._count(start)
                self._scalar(event, start, end)
            case yaml.SequenceStartEvent() | yaml.MappingStartEvent():
                self._count(start)
                self._open(event, start, end)
            case yaml.SequenceEndEvent() | yaml.MappingEndEvent():
                self._close(end)
            case yaml.AliasEvent():
                self._count(start)
                self._alias(str(event.anchor), start, end)
            case yaml.DocumentStartEvent():
                self._document(start, end)

    def explained(self, error: Any) -> Fault:
        """Return the fault that a parser error stands for."""
        length = len(self.file.text)
        mark = error.problem_mark or error.context_mark
        opened = next((frame.node.start for frame in reversed(self.stack) if frame.flow), None)
        complaint = Complaint(
            self.file,
            error.problem or error.context or "this is not YAML",
            min(mark.index, length) if mark else length,
            min(error.context_mark.index, length) if error.context_mark else None,
            opened,
        )
        return explain(complaint)

    def fault(self, fault: Fault) -> None:
        """Record a fault."""
        self.faults.append(fault)

    def blame(self, kind: FaultKind, message: str, start: int, end: int, hint: str = "") -> None:
        """Record a fault about the text from offset ``start`` to offset ``end``."""
        self.faults.append(Fault(kind, message, self.file.span(start, end), help=hint))

    def close_all(self) -> None:
        """Attach the collections that are still open to their parents, after reading stopped early."""
        while self.stack:
            node = self.stack.pop().node
            if not self.stack:
                self.root = node
                return
            parent = self.stack[-1]
            parent.node.end = max(parent.node.end, node.end)
            if parent.node.entries is None:
                parent.node.items.append(node)
            elif parent.key is not None:
                parent.node.entries.append(Entry(parent.key, node))

    def _stop(self, kind: FaultKind, message: str, start: int, hint: str) -> None:
        self.faults.append(Fault(kind, message, self.file.point(start), help=hint))
        self.whole = False
        raise _StopReading

    def _count(self, start: int) -> None:
        self.values += 1
        if self.values > MAX_VALUES:
            hint = "keep long tracks and points in CSV files and name them in the mission"
            self._stop("too-many-values", f"the file holds more than {MAX_VALUES} values", start, hint)

    def _document(self, start: int, end: int) -> None:
        self.documents += 1
        if self.documents > 1:
            hint = "keep each mission in a file of its own"
            self.blame("several-documents", "a second document begins here", start, end, hint)
            raise _StopReading

    def _scalar(self, event: Any, start: int, end: int) -> None:
        end = self._trimmed(start, end)
        text, plain = event.value, event.implicit[0]
        if event.tag is not None:
            known, value = resolve_tagged(event.tag, text)
            if not known:
                self._tag(start)
                value = resolve(text) if event.style is None else text
        else:
            value = resolve(text) if plain else text
        node = Scalar(start, end, value, text)
        if event.anchor is not None:
            self.anchors[event.anchor] = node
        self._place(node, merge=plain and text == "<<")

    def _open(self, event: Any, start: int, end: int) -> None:
        if len(self.stack) >= MAX_DEPTH:
            message = f"lists and mappings are nested more than {MAX_DEPTH} deep"
            self._stop("too-deep", message, start, "a mission needs less than 12 levels")
        mapping = isinstance(event, yaml.MappingStartEvent)
        core = CORE_TAG + ("map" if mapping else "seq")
        if event.tag not in (None, "!", core):
            self._tag(start)
        node = Collection(start, end, entries=[] if mapping else None)
        self.stack.append(_Open(node, event.anchor, bool(event.flow_style)))

    def _close(self, end: int) -> None:
        frame = self.stack.pop()
        node = frame.node
        if frame.flow:
            node.end = max(end, node.end)
        parts = [entry.value for entry in node.entries or ()] + node.items
        node.size += sum(map(size_of, parts))
        node.height += max(map(height_of, parts), default=0)
        if frame.anchor is not None:
            self.anchors[frame.anchor] = node
        self._place(node)

    def _alias(self, name: str, start: int, end: int) -> None:
        target = self.anchors.get(name)
        if any(frame.anchor == name for frame in self.stack):
            hint = "a value cannot hold itself; write out what is meant"
            self.blame(
                "recursive-alias", f"the alias '*{name}' stands inside its own value", start, end, hint
            )
            target = None
        elif target is None:
            near = get_close_matches(name, self.anchors, n=1)
            hint = f"did you mean '*{near[0]}'?" if near else "quote the value if the '*' belongs to it"
            message = f"no value before this line is named '&{name}'"
            self.blame("unknown-alias", message, start, end, hint)
        if target is None:
            self._place(Scalar(start, end, None, ""))
            return
        self.alias_values += size_of(target)
        if self.alias_values > MAX_ALIAS_VALUES:
            message = f"the aliases up to here stand for more than {MAX_ALIAS_VALUES} values"
            self._stop("alias-expansion", message, start, "write values out, or use fewer aliases")
        if len(self.stack) + height_of(target) > MAX_DEPTH:
            message = f"with this alias, lists and mappings are nested more than {MAX_DEPTH} deep"
            self._stop("too-deep", message, start, "a mission needs less than 12 levels")
        self._place(Alias(start, end, target))

    def _place(self, node: Node, *, merge: bool = False) -> None:
        """Attach a finished node to the tree: as the root, the next item, a key, or the value of a key."""
        if not self.stack:
            self.root = node
            return
        frame = self.stack[-1]
        parent = frame.node
        parent.end = max(parent.end, node.end)
        if parent.entries is None:
            parent.items.append(node)
        elif not frame.has_key:
            frame.has_key = True
            frame.key = self._key(frame, node, merge=merge)
        else:
            if frame.key is not None:
                parent.entries.append(Entry(frame.key, node))
            frame.key, frame.has_key = None, False

    def _key(self, frame: _Open, node: Node, *, merge: bool) -> Scalar | None:
        """Return the node as a key, or None if the composer must drop its value."""
        if not isinstance(node, Scalar):
            self._complex_key(node)
            return None
        if merge:
            hint = "YAML 1.2 has no merge keys: write the keys out, or give whole values by alias"
            self.blame("merge-key", "'<<' does not merge here", node.start, node.end, hint)
            return None
        if not isinstance(node.value, str):
            self._key_not_text(node)
        first = frame.seen.setdefault(node.text, node)
        if first is not node:
            self._duplicate(node, first)
            return None
        return node

    def _complex_key(self, node: Node) -> None:
        """Record a key that is not a scalar. Nested ones count once: ``{{ name }}`` is a key inside a key."""
        span = self.file.span(node.start, node.end)
        self.faults = [f for f in self.faults if f.kind != "complex-key" or f.span < span]
        message = "a key is plain text, not a list, a mapping or an alias"
        hint = "write the key as text; put a value that begins with '{', '[' or '*' in quotes"
        self.faults.append(Fault("complex-key", message, span, help=hint))

    def _key_not_text(self, node: Scalar) -> None:
        kind = _kind_of(node)
        hint = f'write it in quotes: "{node.text}"' if len(node.text) < 40 else "write it in quotes"
        written = f"'{shorten(node.text)}' is {kind}, and" if node.text else "this is empty, and"
        self.blame("key-not-text", f"{written} a key is text", node.start, node.end, hint)

    def _duplicate(self, key: Scalar, first: Scalar) -> None:
        line, _ = self.file.position(first.start)
        self.faults.append(
            Fault(
                "duplicate-key",
                f"the key '{shorten(key.text)}' stands here a second time",
                self.file.span(key.start, key.end),
                (f"first given on line {line}",),
                "keep one of the two",
                related=((self.file.span(first.start, first.end), "first given here"),),
            )
        )

    def _tag(self, start: int) -> None:
        """Record the tag that begins at ``start``, or after it if an anchor comes first."""
        text = self.file.text
        sign = text.find("!", start)
        end = sign + len(re.match(_TAG, text[sign:])[0])  # type: ignore[index]  # there is a '!' at sign
        hint = "delete the tag; put the value in quotes if the '!' belongs to it"
        self.blame("tag", f"the tag '{shorten(text[sign:end])}' means nothing in a mission", sign, end, hint)

    def _trimmed(self, start: int, end: int) -> int:
        """Return the end offset of a value, without the blank lines at the end of a block scalar."""
        text = self.file.text
        while end > start and text[end - 1] in " \t\r\n":
            end -= 1
        return end


def _kind_of(node: Scalar) -> str:
    if node.value is None:
        return "the null value"
    return "a truth value" if isinstance(node.value, bool) else "a number"
