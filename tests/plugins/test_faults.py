"""Plugins at fault are named with their package; whoever does not use them is not concerned."""

from __future__ import annotations

import pytest

from shotc import plugins
from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.checking import check_source
from tests.support.film_plans import orbit_plan
from tests.support.plugin_distributions import KIND

MISSION = """\
shotc: 1
mission: pan
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam: {model: x500, home: [0, -30, 0]}}
shots:
  - {id: look, kind: static, drone: cam, at: [-12, -20, 8], look_at: mast}
"""
OF_A_SAMPLE = MISSION + "  - {id: odd, kind: sample, drone: cam}\n"

EMITTER = """
from shotc.plugin_api import Artifact, Emission

class Made:
    name, summary, api = "sample", "made for a test", 1

    def emit(self, plan):
        {body}

PLUGIN = Made()
"""


def checked(mission):
    return check_source(mission.encode(), "m.yaml", None).diagnostics


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise KeyError('lens')", "KeyError: 'lens'"),
        ("return None", "returned a NoneType, not an Expansion"),
        ("return Expansion(keyframes=[1])", "Keyframes in a tuple"),
        ("return Expansion()", "no keyframe"),
        (
            "return Expansion(keyframes=(scene.keyframe((float('nan'), 0.0, 5.0), 'mast'),))",
            "not finite",
        ),
    ],
    ids=["raises", "none", "list", "nothing", "nan"],
)
def test_a_kind_at_fault_is_named_with_its_package_on_the_line_of_the_shot(install, body, said):
    install("kind-maker", "sample", KIND.format(body=body), "kinds")
    (fault,) = checked(OF_A_SAMPLE)
    assert fault.code == "P008"
    assert "kind `sample` of package kind-maker" in fault.message
    assert said in " ".join([fault.message, *fault.notes])
    assert fault.labels[0].span.line == len(OF_A_SAMPLE.splitlines())
    assert compile_source(OF_A_SAMPLE.encode(), "m.yaml", None, PlanOptions()).plan is None


def test_the_place_in_the_code_of_the_kind_is_told(install):
    install("kind-maker", "sample", KIND.format(body="raise KeyError('lens')"), "kinds")
    (fault,) = checked(OF_A_SAMPLE)
    assert any("in expand, line" in note and "module kind_maker" in note for note in fault.notes)


def test_a_kind_that_cannot_be_imported_fails_only_the_missions_that_use_it(install):
    install("broken-maker", "sample", "raise RuntimeError('no such camera')", "kinds")
    assert checked(MISSION) == ()
    (fault,) = checked(OF_A_SAMPLE)
    assert fault.code == "P002"
    assert fault.labels[0].span.line == len(OF_A_SAMPLE.splitlines())


@pytest.mark.slow
def test_an_emitter_that_cannot_be_imported_fails_only_who_asks_for_it(install):
    install("broken-maker", "sample", "raise RuntimeError('no such file')", "emitters")
    assert emit_plan(orbit_plan(), ["csv"]).diagnostics == ()
    made = emit_plan(orbit_plan(), ["csv", "sample"])
    assert [d.code for d in made.diagnostics] == ["P002"]
    assert {a.name for a in made.artifacts} == {"plan.json", "trajectory.csv", "framing.csv"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise ValueError('no room')", "ValueError: no room"),
        ("return b'bytes'", "returned a bytes, not an Emission"),
        ("return Emission((Artifact('../plan.json', b''),))", "in no folder"),
        ("return Emission((Artifact('a.txt', 'text'),))", "Artifacts of bytes"),
        ("raise ModuleNotFoundError('no fastkml', name='fastkml')", "no fastkml"),
    ],
    ids=["raises", "bytes", "outside", "text", "library"],
)
def test_an_emitter_at_fault_is_named_and_the_others_are_written(install, body, said):
    install("file-maker", "sample", EMITTER.format(body=body), "emitters")
    made = emit_plan(orbit_plan(), ["sample", "csv"])
    (fault,) = made.diagnostics
    assert fault.code == "P008"
    assert "emitter `sample` of package file-maker" in fault.message
    assert said in " ".join([fault.message, *fault.notes])
    assert {a.name for a in made.artifacts} == {"plan.json", "trajectory.csv", "framing.csv"}


def test_a_fault_of_our_own_emitter_is_our_bug(monkeypatch):
    csv = type(plugins.discover("emitters").plugins["csv"])

    def fails(self, plan):
        raise RuntimeError("ours")

    monkeypatch.setattr(csv, "emit", fails)
    with pytest.raises(RuntimeError, match="ours"):
        emit_plan(orbit_plan(), ["csv"])
