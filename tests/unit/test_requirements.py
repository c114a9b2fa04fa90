"""The install line names the source that this installation came from."""

from __future__ import annotations

import json

import pytest

from shotc import requirements

CLONE = {"url": "file:///home/ann/my%20shotc", "dir_info": {"editable": True}}
FOLDER = {"url": "file:///home/ann/shotc", "dir_info": {}}
GIT = {"url": "https://forge.example/shotc.git", "vcs_info": {"vcs": "git", "commit_id": "abc123"}}


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
