"""Discovery through real package metadata: a distribution is laid on sys.path and found there."""

from __future__ import annotations

import pytest

from shotc import plugins
from shotc.requirements import install_line
from tests.support.plugin_distributions import KIND, lay

MODULE = """
class Sample:
    name = {name!r}
    summary = "a sample"
    api = {api}

PLUGIN = Sample()
"""


def test_a_third_party_emitter_is_found_and_named_with_its_package(install):
    install("sample-maker", "sample", MODULE.format(name="sample", api=1))
    assert ("sample", "a sample", "sample-maker") in plugins.listing("emitters")


def test_a_clash_uses_neither_and_names_both_packages(install):
    install("maker-one", "sample", MODULE.format(name="sample", api=1))
    install("maker-two", "sample", MODULE.format(name="sample", api=1))
    found = plugins.discover("emitters")
    assert "sample" not in found.plugins
    (clash,) = [d for d in found.diagnostics if d.code == "P001"]
    assert "maker-one" in clash.notes[0]
    assert "maker-two" in clash.notes[0]


def test_a_package_that_is_on_the_path_twice_counts_once(install, tmp_path, monkeypatch):
    install("sample-maker", "sample", MODULE.format(name="sample", api=1))
    (tmp_path / "again").mkdir()
    lay(tmp_path / "again", "sample-maker", "sample", MODULE.format(name="sample", api=1), "emitters")
    monkeypatch.syspath_prepend(str(tmp_path / "again"))
    plugins.forget()
    found = plugins.discover("emitters")
    assert ("sample" in found.plugins, found.diagnostics) == (True, ())


def test_a_plugin_may_not_take_the_name_of_ours(install):
    install("csv-thief", "csv", MODULE.format(name="csv", api=1))
    found = plugins.discover("emitters")
    assert "csv" not in found.plugins
    assert [d.code for d in found.diagnostics] == ["P001"]


def test_a_plugin_that_raises_on_import_is_a_diagnostic_with_its_words(install):
    install("broken-maker", "broken", "raise RuntimeError('no such camera')")
    (fault,) = [d for d in plugins.discover("emitters").diagnostics if d.code == "P002"]
    assert "broken-maker" in fault.notes[0]
    assert "no such camera" in fault.notes[1]


@pytest.mark.parametrize(("name", "api"), [("sample", 2), ("other", 1)])
def test_another_api_version_or_name_is_refused(install, name, api):
    install("old-maker", "sample", MODULE.format(name=name, api=api))
    found = plugins.discover("emitters")
    assert "sample" not in found.plugins
    assert [d.code for d in found.diagnostics] == ["P003"]


def test_listing_names_imports_nothing(install):
    install("quiet-maker", "quiet", "raise RuntimeError('imported')")
    assert "quiet" in plugins.names("emitters")


def test_a_plugin_that_lacks_an_optional_library_is_not_broken(install):
    install("viewer-maker", "viewer", "raise ModuleNotFoundError('no rerun', name='rerun')")
    found = plugins.discover("emitters")
    assert found.lacking == {"viewer": "rerun"}
    assert found.diagnostics == ()
    assert ("viewer", "needs rerun, which is not installed", "viewer-maker") in plugins.listing("emitters")


def test_a_broken_kind_of_another_package_is_known_as_unusable(install):
    install("broken-maker", "broken", "raise RuntimeError('no such camera')", group="kinds")
    install("lacking-maker", "lacking", "raise ModuleNotFoundError('no scipy', name='scipy')", group="kinds")
    found = plugins.shot_kinds()
    assert not {"broken", "lacking"} & set(found.plugins)
    assert {name: d.code for name, d in found.unusable.items()} == {"broken": "P002", "lacking": "P004"}


def test_a_kind_may_not_take_the_name_of_ours(install):
    install("orbit-thief", "orbit", MODULE.format(name="orbit", api=1), group="kinds")
    found = plugins.shot_kinds()
    assert "orbit" not in found.plugins
    assert "spiral" in found.plugins
    assert [d.code for d in found.diagnostics] == ["P001"]


def test_both_ways_to_the_kinds_find_the_same(install):
    install("kind-maker", "sample", KIND.format(body="return Expansion()"), group="kinds")
    assert plugins.shot_kinds().plugins["sample"].package == "kind-maker"
    assert dict(plugins.shot_kinds().plugins) == dict(plugins.discover("kinds").plugins)


@pytest.mark.parametrize(
    ("libraries", "extra"),
    [
        (["scipy", "clarabel"], "plan"),
        (["rerun"], "view"),
        (["rerun.blueprint"], "view"),
        (["rerun", "numpy"], "all"),
    ],
    ids=" ".join,
)
def test_missing_libraries_are_named_with_the_extra_that_brings_them(libraries, extra):
    fault = plugins.not_installed("P005", "this output", libraries)
    assert fault.code == "P005"
    assert fault.message == f"this output needs {', '.join(libraries)}, not installed here"
    assert fault.help.startswith(f"run `{install_line(extra)}`")


def test_one_plugin_is_loaded_and_named_with_its_package(install):
    install("sample-maker", "sample", MODULE.format(name="sample", api=1), group="refiners")
    found = plugins.one("refiners", "sample")
    assert found.plugin.name == "sample"
    assert (found.package, found.reference, found.diagnostics) == ("sample-maker", "sample_maker:PLUGIN", ())


@pytest.mark.parametrize("group", ["refiners", "replanners"])
def test_whatever_the_seat_a_name_that_two_packages_take_is_neither(install, group):
    install("maker-one", "sample", MODULE.format(name="sample", api=1), group=group)
    install("maker-two", "sample", MODULE.format(name="sample", api=1), group=group)
    assert [d.code for d in plugins.one(group, "sample").diagnostics] == ["P001"]


def test_one_plugin_is_used_though_another_is_broken(install):
    install("sample-maker", "sample", MODULE.format(name="sample", api=1), group="refiners")
    install("broken-maker", "broken", "raise RuntimeError('no such solver')", group="refiners")
    assert plugins.one("refiners", "sample").plugin is not None
    broken = plugins.one("refiners", "broken")
    assert broken.plugin is None
    assert [d.code for d in broken.diagnostics] == ["P002"]


def test_a_refiner_that_lacks_an_optional_library_says_which(install):
    install("fast-maker", "fast", "raise ModuleNotFoundError('no scipy', name='scipy')", group="refiners")
    (missing,) = plugins.one("refiners", "fast").diagnostics
    assert (missing.code, "refiner `fast` needs scipy" in missing.message) == ("P004", True)


def test_our_refiner_is_the_usual_one_where_it_is_installed(install, monkeypatch):
    monkeypatch.setattr(plugins, "names", lambda group: ["none", "other"])
    assert plugins.usual_refiner() == "none"
    monkeypatch.setattr(plugins, "names", lambda group: ["none", "other", "ours"])
    assert plugins.usual_refiner() == "ours"
