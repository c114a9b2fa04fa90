"""Commands that install optional libraries for this installation of shotc."""

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
"""Libraries that each have their own extra."""
PLUGINS = {"casadi": "shotc-casadi"}
"""Libraries that no extra brings, with the plugin package of ours that does."""


def remedy(libraries: Sequence[str]) -> str:
    """Return the help text of a diagnostic for missing optional libraries."""
    packages = {library.partition(".")[0] for library in libraries}
    if VIEWER in packages and not has_viewer():
        packages -= {VIEWER}
        if not packages:
            return (
                "leave it out: the viewer has no release for Intel Macs; the output `storyboard` shows a "
                "plan without it, and `shotc view` on another machine takes the plan.json of this one"
            )
    plugins = sorted(PLUGINS[name] for name in packages & PLUGINS.keys())
    if plugins:  # Their packages need the extra `plan`, so they bring it, too.
        return f"run `pip install {' '.join(_requirement(name, _source(name)) for name in plugins)}`"
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
    """Return whether the extra `view` installs the viewer here, by its marker in pyproject.toml."""
    return sys.platform != "darwin" or platform.machine() == "arm64"


def install_line(extra: str) -> str:
    """Return the pip command that installs an extra from the source of this installation."""
    return f"pip install {_requirement(f'{PACKAGE}[{extra}]', _source(PACKAGE))}"


def _source(package: str) -> dict[str, Any]:
    """Return the source of a package as recorded by pip (PEP 610); empty for a package index."""
    try:
        text = distribution(package).read_text("direct_url.json")
        source = json.loads(text or "{}")
    except (PackageNotFoundError, OSError, ValueError):
        return {}
    return source if isinstance(source, dict) else {}


def _requirement(wanted: str, source: dict[str, Any]) -> str:
    """Return the requirement for pip, quoted for a shell.

    wanted : the package, with its extra if there is one
    """
    url = source.get("url")
    if not isinstance(url, str):
        return f"'{wanted}'"
    if source.get("dir_info", {}).get("editable") and url.startswith("file:"):
        extra = "".join(wanted.partition("[")[1:])
        return f"-e '{unquote(urlsplit(url).path)}{extra}'"
    version = source.get("vcs_info", {})
    if version:
        url = f"{version.get('vcs', 'git')}+{url}@{version.get('commit_id', '')}"
    if "subdirectory" in source:
        url += f"#subdirectory={source['subdirectory']}"
    return f"'{wanted} @ {url}'"
