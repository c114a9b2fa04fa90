"""The names that a mission may allow: breaks of film grammar; subjects hidden, soft or blurred on purpose."""

from typing import Annotated

from shotc.ir.allow import BLURRED, FAST_PAN, HIDDEN, SOFT
from shotc.spec.fieldtypes import NamedOr

GRAMMAR = ("crossing-the-line", "jump-cut", "short-shot", "walks-out-of-frame", FAST_PAN)

_SLUG = NamedOr("AllowedWarning", {slug: slug for slug in (*GRAMMAR, HIDDEN, SOFT, BLURRED)}, "warning")

Allowed = tuple[Annotated[str, _SLUG], ...]
