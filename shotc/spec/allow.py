"""What a mission may allow by name: breaks of film grammar, and shots whose subject is hidden on purpose."""

from typing import Annotated

from shotc.ir.allow import FAST_PAN, HIDDEN
from shotc.spec.fieldtypes import NamedOr

GRAMMAR = ("crossing-the-line", "jump-cut", "short-shot", "walks-out-of-frame", FAST_PAN)

_SLUG = NamedOr("AllowedWarning", {slug: slug for slug in (*GRAMMAR, HIDDEN)}, "warning")

Allowed = tuple[Annotated[str, _SLUG], ...]
