"""The MultiDrone project's own missions, where they are: they are not ours to copy.

`MULTIDRONE_MISSIONS=DIR` names their folder; without it they are looked for beside the repository.
"""

from __future__ import annotations

import os
from pathlib import Path

_BESIDE = Path(__file__).parents[3] / "shared" / "data" / "multidrone-missions"
ORIGINALS = sorted(Path(os.environ.get("MULTIDRONE_MISSIONS") or _BESIDE).glob("*.xml"))
