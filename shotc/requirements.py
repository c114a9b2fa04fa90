"""What brings optional libraries to this very installation of shotc."""

import json
import platform
import sys
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, distribution
from typing import Any
from urllib.parse import unquote, urlsplit

PACKAGE = "shotc"
VIEWER = "rerun"
PLACES = frozenset({"pyproj", "laspy", "lazrs"})
"""Libraries of the extra `geo`."""
SENDER = "pymavlink"
ALONE = {"rotorpy": "rotorpy", "distributed": "dask"}
"""Libraries of which each is an extra by itself."""


def remedy(libraries: Sequence[str]) -> str:
    """Return what to do where optional libraries are missing, as the help of a diagnostic."""
    packages = {library.partition(".")[0] for library in libraries}
    if VIEWER in packages and not has_viewer():
        packages -= {VIEWER}
        if not packages:
            return (
                "leave it out: the viewer has no release for Intel Macs; the output `storyboard` shows a "
                "plan without it, and `shotc view` on another machine takes the plan.json of this one"
            )
    if packages <= ALONE.keys():
        return f"run `{install_line(','.join(sorted(ALONE[name] for name in packages)))}`"
    if SENDER in packages:
        return f"run `{install_line('stream' if packages == {SENDER} else 'all')}`"
    if PLACES & packages:
        return f"run `{install_line('geo' if packages <= PLACES else 'all')}`"
    extra = "view" if packages == {VIEWER} else "all" if VIEWER in packages else "plan"
    also = "; `all` instead of `plan` brings the viewer, too" if extra == "plan" and has_viewer() else ""
    return f"run `{install_line(extra)}`{also}"


def has_viewer() -> bool:
    """Whether the extra `view` brings the viewer here, as its marker in pyproject.toml says."""
    return sys.platform != "darwin" or platform.machine() == "arm64"


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
