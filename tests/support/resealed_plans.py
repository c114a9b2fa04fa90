"""Plans that were edited by someone who knows the format: the seal and the certificate made anew."""

import json
from typing import Any

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
