"""The command that adds optional libraries to this very installation of shotc."""

import json
from importlib.metadata import PackageNotFoundError, distribution
from typing import Any
from urllib.parse import unquote, urlsplit

PACKAGE = "shotc"


def install_line(extra: str) -> str:
    """Return the pip command that brings an extra to where shotc was installed from."""
    return f"pip install {_requirement(extra, _source())}"


def _source() -> dict[str, Any]:
    """Return where pip says that shotc came from (PEP 610); empty for a package index."""
    try:
        text = distribution(PACKAGE).read_text("direct_url.json")
        source = json.loads(text or "{}")
    except (PackageNotFoundError, OSError, ValueError):
        return {}
    return source if isinstance(source, dict) else {}


def _requirement(extra: str, source: dict[str, Any]) -> str:
    """Return what pip is to install, as a shell reads it."""
    url = source.get("url")
    if not isinstance(url, str):
        return f"'{PACKAGE}[{extra}]'"
    if source.get("dir_info", {}).get("editable") and url.startswith("file:"):
        return f"-e '{unquote(urlsplit(url).path)}[{extra}]'"
    version = source.get("vcs_info", {})
    if version:
        url = f"{version.get('vcs', 'git')}+{url}@{version.get('commit_id', '')}"
    return f"'{PACKAGE}[{extra}] @ {url}'"
