"""Plans that were edited by someone who knows the format: the seal and the certificate made anew."""

import json
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from shotc import api
from shotc.ir.passes import PassContext
from shotc.passes.verify import judge
from shotc.planfile.codec import encode
from shotc.planfile.read import read_plan
from shotc.planfile.write import seal

Document = dict[str, Any]


def resealed(document: Document) -> bytes:
    """Return a plan whose seal and certificate are those of what it says now."""
    document["mission_sha256"] = seal(document["mission"])
    read = read_plan(json.dumps(document).encode(), "plan.json")
    assert read.trajectory is not None, read.diagnostics
    document["certificate"] = encode(judge(read.trajectory, PassContext()).certificate)
    return json.dumps(document).encode()


def refused(plan: bytes, edit: Callable[[Document], None], sealed: Callable[[], bool]) -> bool:
    """Tell whether an edit of a plan is refused, or changes nothing.

    sealed : asked after the edit, whether seal and certificate are made anew where the plan can be read
    """
    document = json.loads(plan)
    edit(document)
    if document == json.loads(plan):
        return True
    data = json.dumps(document).encode()
    if sealed():
        with suppress(AssertionError):
            data = resealed(document)
    report = api.verify_plan(data, "plan.json")
    assert report.plan is not None or report.diagnostics
    return report.plan is None
