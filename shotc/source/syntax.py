"""Translate the errors of the YAML parser into terms of the mission's author.

The parser only reports what it expected. A rule looks at the text around that place and states the fault.
"""

import re
from collections.abc import Callable
from typing import NamedTuple

from shotc.source.fault import Fault, shorten
from shotc.source.file import SourceFile, Span
from shotc.source.limits import MAX_DEPTH

_QUOTE = "put the value in quotes"
_INDENT = "indent the keys of one mapping, and the items of one list, by the same number of spaces"
_QUOTED = re.compile(r"""(?<![^\s\[{,])(?:"(?:\\.|[^"\\])*"|'(?:[^']|'')*')""")
_COMMENT = re.compile(r"(?<![^\s\[{,])#")
_WORD = re.compile(r"#[^\s,\[\]{}]+")
_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{3}){1,2}(?![^\s,\[\]{}])")


class Complaint(NamedTuple):
    """A parser error: its message and its offsets into the text.

    start  : offset at which the construct in question began, or None
    opened : offset of the innermost open ``[`` or ``{``, or None
    """

    file: SourceFile
    problem: str
    at: int
    start: int | None
    opened: int | None

    @property
    def text(self) -> str:
        """The whole source text."""
        return self.file.text

    @property
    def character(self) -> str:
        """The character at the place of the error, or an empty string at the end."""
        return self.text[self.at : self.at + 1]

    @property
    def before(self) -> str:
        """The line up to the place of the error."""
        _, column = self.file.position(self.at)
        return self.text[self.at - column + 1 : self.at]

    @property
    def line_rest(self) -> int:
        """The offset at which the line of the error ends, without trailing blanks."""
        line, column = self.file.position(self.at)
        return self.at - column + 1 + len(self.file.line(line).rstrip())

    @property
    def rest(self) -> Span:
        """The span from the place of the error to the end of its line."""
        return self.file.span(self.at, max(self.at, self.line_rest))


def explain(complaint: Complaint) -> Fault:
    """Return the fault that a parser error stands for."""
    if tab := _tab(complaint):
        return tab
    for words, rule in _RULES:
        if words in complaint.problem:
            return rule(complaint)
    return _fault(complaint, complaint.problem)


def _fault(c: Complaint, message: str, hint: str = "") -> Fault:
    return Fault("syntax", message, c.file.point(c.at), help=hint)


def _tab(c: Complaint) -> Fault | None:
    """Return the fault of a tab at the place of the error or in the indentation of its line."""
    line, column = c.file.position(c.at)
    content = c.file.line(line)
    indent = content[: len(content) - len(content.lstrip(" \t"))]
    if c.character == "\t":
        start = c.at
    elif "\t" in indent and c.problem != "found unexpected end of stream":
        start = c.at - column + 1 + indent.index("\t")
    else:
        return None
    end = start + 1
    while c.text[end : end + 1] == "\t":
        end += 1
    others = _tabbed_lines(c.file, line)
    notes = (f"tabs also begin {others}",) if others else ()
    return Fault(
        "tab-indentation",
        "a tab cannot indent YAML",
        c.file.span(start, end),
        notes,
        "indent with spaces",
    )


def _tabbed_lines(file: SourceFile, but: int) -> str:
    """List the first few other lines that are indented with a tab."""
    numbers = [
        number
        for number, line in enumerate(file.lines(), 1)
        if number != but and line.strip() and "\t" in line[: len(line) - len(line.lstrip())]
    ]
    if not numbers:
        return ""
    listed = ", ".join(str(n) for n in numbers[:8])
    more = f" and {len(numbers) - 8} more" if len(numbers) > 8 else ""
    return f"line{'s' if len(numbers) > 1 else ''} {listed}{more}"


def _bad_start(c: Complaint) -> Fault:
    return Fault(
        "needs-quotes",
        f"a value cannot begin with '{c.character}' unless it is quoted",
        c.rest,
        help=f'{_QUOTE}: "{c.text[c.at : c.line_rest]}"' if c.line_rest - c.at < 40 else _QUOTE,
    )


def _second_colon(c: Complaint) -> Fault:
    """Return the fault of a ': ' where no key can be: second in its line, or indented too deep."""
    before = c.before
    key = before.lstrip(" -")
    if ": " in key or key.endswith(":"):
        return Fault(
            "needs-quotes",
            "a second ': ' in one line",
            c.file.point(c.at),
            help="quote the value if the colon belongs to it, or begin a new line after the first key",
        )
    start = c.at - len(key)
    return Fault(
        "indentation",
        f"the key '{shorten(key)}' cannot begin here",
        c.file.span(start, c.at),
        ("the value above still goes on: it has text of its own, or misses the blank after its colon",),
        "write each key as 'key: value', and indent the keys of one mapping alike",
    )


def _no_colon(c: Complaint) -> Fault:
    start = c.at if c.start is None else c.start
    line, column = c.file.position(start)
    end = start - column + 1 + len(c.file.line(line).rstrip())
    return Fault(
        "syntax",
        "this line has no ': ' after its key",
        c.file.span(start, max(end, start + 1)),
        help="write 'key: value', with a blank after the colon",
    )


def _stray_item(c: Complaint) -> Fault:
    return Fault(
        "indentation",
        "a list item cannot begin here",
        c.file.point(c.at),
        help="begin the item on a line of its own, below the key of the list",
    )


def _not_a_key(c: Complaint) -> Fault:
    """Return the fault of text that is no key: a stray bracket, trailing text or an odd indent."""
    if c.character and c.character in "]}":
        return _stray_bracket(c)
    if c.character == ":":
        return _no_key(c)
    if c.before.strip(" -"):
        return Fault(
            "syntax",
            "text after the end of a value",
            c.rest,
            help="quote the whole value, or begin a new line",
        )
    if c.text[c.at : c.at + 2] in ("- ", "-\n", "-"):
        message = "a list item among keys, or indented like no item above"
    else:
        message = "the indentation of this line fits no line above"
    return Fault("indentation", message, c.rest, help=_INDENT)


def _stray_bracket(c: Complaint) -> Fault:
    return _fault(c, f"this '{c.character}' closes nothing", "delete it, or add what it should close")


def _not_an_item(c: Complaint) -> Fault:
    if c.before.strip(" -"):
        return _not_a_key(c)
    return Fault(
        "indentation",
        "this line is no item of the list above",
        c.rest,
        help=_INDENT,
    )


def _unclosed_bracket(c: Complaint) -> Fault:
    opened = c.at if c.start is None else c.start
    bracket = c.text[opened : opened + 1]
    hidden = value_in_comment(c.text, opened, c.line_rest)
    if hidden is not None:
        return _hidden(c.file, bracket, opened, hidden)
    close = "]" if bracket == "[" else "}"
    return Fault(
        "unclosed",
        f"this '{bracket}' is not closed, or a comma is missing after it",
        c.file.point(opened),
        related=((c.file.point(c.at), f"',' or '{close}' expected before this"),),
        help=f"add the '{close}', or the comma between the values",
    )


def _hidden(file: SourceFile, bracket: str, opened: int, hidden: tuple[int, int]) -> Fault:
    """Return the fault of a `#` that turns a value, and the closing bracket after it, into a comment."""
    value = shorten(file.text[hidden[0] : hidden[1]])
    return Fault(
        "needs-quotes",
        "'#' begins a comment, so the rest of this line is not read",
        file.span(*hidden),
        help=f'{_QUOTE}: "{value}"',
        related=((file.point(opened), f"this '{bracket}' is not closed"),),
    )


def _unclosed_quote(c: Complaint) -> Fault:
    opened = c.at if c.start is None else c.start
    quote = c.text[opened : opened + 1]
    return Fault(
        "unclosed",
        "this quotation mark is not closed",
        c.file.point(opened),
        help=f"add a {quote} at the end of the value",
    )


def _no_content(c: Complaint) -> Fault:
    if not c.text[c.at :].strip() and c.opened is not None:
        return _unclosed_bracket(Complaint(c.file, c.problem, c.at, c.opened, c.opened))
    if c.character and c.character in "]}":
        return _stray_bracket(c)
    if c.character == ",":
        return _fault(c, "nothing stands before this comma", "delete the comma, or add the value before it")
    if c.character == ":":
        return _no_key(c)
    return _fault(c, "a value is missing here")


def _no_key(c: Complaint) -> Fault:
    return _fault(c, "no key stands before this colon", "write 'key: value'")


def _escape(c: Complaint) -> Fault:
    start = max(c.at - 2, c.text.rfind("\\", 0, c.at + 1))  # the parser may stop after the backslash
    return Fault(
        "needs-quotes",
        f"'{c.text[start : start + 2].strip()}' is no escape sequence of YAML",
        c.file.span(start, start + 2),
        help="write the backslash twice, or use single quotes",
    )


def _anchor_name(c: Complaint) -> Fault:
    start = c.at if c.start is None else c.start
    sign = c.text[start : start + 1]
    kind = {"*": "an alias", "&": "an anchor"}.get(sign, "a name")
    return Fault(
        "needs-quotes",
        f"'{sign}' begins {kind}, and no name follows",
        c.file.point(start),
        help=f"{_QUOTE} if the '{sign}' belongs to it",
    )


def _tag_handle(c: Complaint) -> Fault:
    start = c.at if c.start is None else c.start
    word = c.text[start : c.line_rest].split(maxsplit=1)
    end = start + len(word[0]) if word else start + 1
    return Fault(
        "tag",
        "a mission has no tags",
        c.file.span(start, end),
        help=f"delete the tag; {_QUOTE} if the '!' belongs to it",
    )


def _after_end(c: Complaint) -> Fault:
    return Fault(
        "syntax",
        "text after the end of the document",
        c.rest,
        help="a mission is one mapping of keys to values; delete what follows it",
    )


def _too_deep(c: Complaint) -> Fault:
    """Return the fault of a depth that the parser itself refuses (libyaml does since release 0.2.6)."""
    message = f"lists and mappings are nested more than {MAX_DEPTH} deep"
    return Fault("too-deep", message, c.file.point(c.at), help="a mission needs less than 12 levels")


def _directive(c: Complaint) -> Fault:
    line_start = c.at - len(c.before)
    return Fault(
        "syntax",
        "this directive is none that YAML 1.2 knows",
        c.file.span(line_start, max(c.line_rest, line_start + 1)),
        help="delete the line; a mission needs no directives",
    )


# Words in the parser's message, and the rule for them; the first match counts.
_RULES: tuple[tuple[str, Callable[[Complaint], Fault]], ...] = (
    ("cannot start any token", _bad_start),
    ("mapping values are not allowed", _second_colon),
    ("could not find expected ':'", _no_colon),
    ("block sequence entries are not allowed", _stray_item),
    ("did not find expected key", _not_a_key),
    ("expected <block end>", _not_a_key),
    ("did not find expected '-' indicator", _not_an_item),
    ("did not find expected ',' or", _unclosed_bracket),
    ("expected ',' or", _unclosed_bracket),
    ("found unexpected end of stream", _unclosed_quote),
    ("found unexpected document indicator", _unclosed_quote),
    ("did not find expected node content", _no_content),
    ("unknown escape character", _escape),
    ("hexdecimal number", _escape),
    ("invalid Unicode character escape", _escape),
    ("alphabetic or numeric character", _anchor_name),
    ("undefined tag handle", _tag_handle),
    ("expected <document start>", _after_end),
    ("maximum nesting depth", _too_deep),
    ("directive", _directive),
    ("incompatible YAML document", _directive),
)


def value_in_comment(text: str, start: int, end: int) -> tuple[int, int] | None:
    """Return the offsets of the first value between ``start`` and ``end`` that a `#` made a comment, or None.

    Such a value follows a colon and has no blank after the `#`, or it is a colour such as ``#ff8000``.
    """
    for line in text[start:end].splitlines(keepends=True):
        seen = _QUOTED.sub(lambda quoted: "'" * len(quoted[0]), line)
        sign = _COMMENT.search(seen)
        if sign is not None:
            first = _WORD if seen[: sign.start()].rstrip().endswith(":") else _COLOUR
            match = first.match(seen, sign.start())
            if match is not None:
                return (start + match.start(), start + match.end())
        start += len(line)
    return None
