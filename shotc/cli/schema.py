"""``shotc schema``: the JSON Schema of a mission, for editors and generators."""

from __future__ import annotations

import json

from shotc.cli import console


def schema() -> None:
    """Print the JSON Schema of a mission, with the kinds that are installed.

    Example: `shotc schema > mission.schema.json`; an editor completes and checks a mission
    whose first line is `# yaml-language-server: $schema=mission.schema.json`.
    """
    from shotc.api import json_schema

    console.out(json.dumps(json_schema(), indent=2))
