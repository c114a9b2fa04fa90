"""The install line names the source that this installation came from."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from shotc import plugins, requirements

ROOT = Path(__file__).parents[2]
CLONE = {"url": "file:///home/ann/my%20shotc", "dir_info": {"editable": True}}
FOLDER = {"url": "file:///home/ann/shotc", "dir_info": {}}
GIT = {"url": "https://forge.example/shotc.git", "vcs_info": {"vcs": "git", "commit_id": "abc123"}}


def project(folder):
    return tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def brought(extra):
    """Return the distributions that an extra brings, through other extras too."""
    for line in project(ROOT)["optional-dependencies"][extra]:
        needed = Requirement(line)
        if needed.name == "shotc":
            for other in needed.extras:
                yield from brought(other)
        yield needed.name


@pytest.mark.parametrize(
    ("source", "line"),
    [
        (CLONE, "pip install -e '/home/ann/my shotc[plan]'"),
        (FOLDER, "pip install 'shotc[plan] @ file:///home/ann/shotc'"),
        (GIT, "pip install 'shotc[plan] @ git+https://forge.example/shotc.git@abc123'"),
        ({}, "pip install 'shotc[plan]'"),
    ],
    ids=["editable", "folder", "git", "index"],
)
def test_the_line_installs_from_where_shotc_came(monkeypatch, source, line):
    class Installed:
        def read_text(self, name):
            assert name == "direct_url.json"
            return json.dumps(source) if source else None

    monkeypatch.setattr(requirements, "distribution", lambda name: Installed())
    assert requirements.install_line("plan") == line


def test_without_metadata_the_package_is_named(monkeypatch):
    def missing(name):
        raise requirements.PackageNotFoundError(name)

    monkeypatch.setattr(requirements, "distribution", missing)
    assert requirements.install_line("view") == "pip install 'shotc[view]'"


@pytest.mark.parametrize(
    ("system", "machine"),
    [
        ("linux", "x86_64"),
        ("linux", "aarch64"),
        ("darwin", "arm64"),
        ("darwin", "x86_64"),
        ("win32", "AMD64"),
    ],
)
def test_the_help_offers_the_viewer_where_the_extra_brings_it(monkeypatch, system, machine):
    monkeypatch.setattr(requirements.sys, "platform", system)
    monkeypatch.setattr(requirements.platform, "machine", lambda: machine)
    (viewer,) = project(ROOT)["optional-dependencies"]["view"]
    marker = Requirement(viewer).marker
    assert marker is not None
    brings = marker.evaluate({"sys_platform": system, "platform_machine": machine})
    assert requirements.has_viewer() == brings
    assert ("[view]" in requirements.remedy(["rerun"])) == brings
    assert ("storyboard" in requirements.remedy(["rerun"])) == (not brings)
    assert ("[all]" in requirements.remedy(["rerun", "numpy"])) == brings
    assert ("viewer" in requirements.remedy(["numpy"])) == brings
    assert "[plan]" in requirements.remedy(["numpy"])
    assert "[geo]" in requirements.remedy(["pyproj"])
    assert "[all]" in requirements.remedy(["pyproj", "numpy"])


@pytest.mark.parametrize("library", plugins.OPTIONAL)
def test_what_the_help_installs_brings_the_library(monkeypatch, library):
    def editable(package):
        folder = ROOT if package == "shotc" else ROOT / "plugins" / package
        return {"url": folder.as_uri(), "dir_info": {"editable": True}}

    monkeypatch.setattr(requirements, "_source", editable)
    (line,) = re.findall(r"^run `pip install -e '(.*?)'`", requirements.remedy([library]))
    folder, _, extra = line.partition("[")
    needs = brought(extra.removesuffix("]")) if extra else map(name, project(Path(folder))["dependencies"])
    assert {"rerun": "rerun-sdk"}.get(library, library) in set(needs)


def name(line):
    return Requirement(line).name


def test_a_plugin_of_a_repository_is_installed_from_its_folder_in_it(monkeypatch):
    source = GIT | {"subdirectory": "plugins/shotc-casadi"}
    monkeypatch.setattr(requirements, "_source", lambda package: source if package == "shotc-casadi" else {})
    wanted = "shotc-casadi @ git+https://forge.example/shotc.git@abc123#subdirectory=plugins/shotc-casadi"
    assert requirements.remedy(["casadi", "numpy"]) == f"run `pip install '{wanted}'`"
