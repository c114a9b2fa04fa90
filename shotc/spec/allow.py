"""The warnings that a mission may allow by name: those of film grammar, which a filmmaker may break."""

from typing import Annotated

from shotc.spec.fieldtypes import NamedOr

GRAMMAR = ("crossing-the-line", "jump-cut", "short-shot", "walks-out-of-frame", "fast-pan")

_SLUG = NamedOr("AllowedWarning", {slug: slug for slug in GRAMMAR}, "warning")

Allowed = tuple[Annotated[str, _SLUG], ...]
