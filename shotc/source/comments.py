"""Find values that YAML reads as a comment, because the author wrote them after a `#`."""

import re

_QUOTED = re.compile(r"""(?<![^\s\[{,])(?:"(?:\\.|[^"\\])*"|'(?:[^']|'')*')""")
_COMMENT = re.compile(r"(?<![^\s\[{,])#")
_WORD = re.compile(r"#[^\s,\[\]{}]+")
_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{3}){1,2}(?![^\s,\[\]{}])")


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
