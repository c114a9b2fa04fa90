"""The documentation page: what stands between two marks in it is written by the run."""

from __future__ import annotations

BEGIN = "<!-- written by `make papers`: do not edit below -->"
END = "<!-- end of what `make papers` writes -->"


def filled(text: str, body: str) -> str:
    """Return the page with other contents between its marks.

    Raises ValueError where a mark is missing.
    """
    head, begin, rest = text.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        raise ValueError("the page has no marks to write between")
    return f"{head}{BEGIN}\n\n{body.strip()}\n\n{END}{tail}"
