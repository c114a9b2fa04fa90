"""What `shotc stream` prints, and how it ends; vehicles are simulated, and so is time."""

from __future__ import annotations

import json
import re
import signal
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from shotc.diag.registry import has_errors
from shotc.stream.session import unplaced
from tests.cli.conftest import Run
from tests.support.compiled import compiled_text
from tests.support.records import replace
from tests.support.show_plans import plan as show_plan
from tests.support.stream.autopilot import PX4_HOLD, Script
from tests.support.stream.plans import hop_plan, with_target
from tests.support.stream.worlds import EPOCH, World, free_port, send_json

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).parents[2] / "shotc" / "docs" / "flying.md").read_text(encoding="utf-8")


@pytest.fixture
def flying(monkeypatch, tmp_path):
    """Give the command a plan made by hand, and a clock that drives its vehicles."""
    worlds = []

    def made(plan, **more):
        world = World(plan, **more)
        worlds.append(world)
        report = SimpleNamespace(plan=plan, diagnostics=(), sources={})
        monkeypatch.setattr("shotc.cli.stream.prove", lambda _path: report)
        monkeypatch.setattr("shotc.cli.stream.WallClock", lambda: world.clock)
        return world, [
            word for name, port in world.ports.items() for word in ("--to", f"{name}=udp:127.0.0.1:{port}")
        ]

    yield made
    for world in worlds:
        world.stack.close()


@pytest.mark.long
def test_the_commands_of_the_guide_fly_its_mission(run: Run, flying) -> None:
    (text,) = re.findall(r"```yaml\n(# walker.yaml\n.*?)```", PAGE, re.DOTALL)
    lines = dict.fromkeys(re.findall(r"^shotc (stream out/walker [^#\n]*)", PAGE, re.MULTILINE))
    commands = [line.split() for line in lines]
    assert [len(words) for words in commands] == [4, 7, 5]  # a dry run, a flight with a target, one without
    plan = compiled_text(text, "none").plan
    walker = plan.trajectory.keyframes.mission.target("walker")
    for command in commands:
        world, to = flying(plan, targets=("walker",))
        said, flies = world.targets["walker"], "--arm" in command
        began = world.clock.time
        for k in range(160 if flies else 0):
            x, y, _ = walker.at(0.5 * k)
            send = partial(send_json, said, json.dumps({"x": x, "y": y + 0.5}))
            world.clock.events.append((began + 0.5 * k, send))
        ports = {"udp:14540": to[1].partition("=")[2], "walker=udp:14600": f"walker={said}"}
        done = run(*(ports.get(word, word) for word in command))
        assert done.code == 0, done.err
        (autopilot,) = world.autopilots.values()
        assert ("landed" in done.out) is flies
        assert (len(autopilot.setpoints) > 2000) is flies
        assert [on for _, on in autopilot.recording] == ([True, False] if flies else [])


def test_a_dry_run_says_what_it_would_do_and_moves_nothing(run: Run, flying) -> None:
    world, to = flying(hop_plan("near", "far", waits=5.0))
    done = run("stream", "plan.json", *to)
    assert done.code == 0
    assert "near  vehicle          PX4, system 1" in done.out
    assert "hold (COM_OBL_RC_ACT), return (NAV_DLL_ACT); COM_OF_LOSS_T 1 s" in done.out
    assert "by-far from 11.0 s" in done.out
    assert "dry run: nothing was armed or moved" in done.out
    assert not any(autopilot.setpoints for autopilot in world.autopilots.values())


def test_meant_it_flies_and_says_how_well_it_was_sent(run: Run, flying) -> None:
    world, to = flying(hop_plan())
    done = run("stream", "plan.json", "--to", to[1].partition("=")[2], "--arm")
    assert done.code == 0
    assert "landed" in done.out
    assert "sent every 20 ms, after its moment: median 0.00 ms" in done.out
    assert "cam1: records shot `by-cam1`" in done.err
    assert len(world.autopilots["cam1"].setpoints) > 1500


def test_with_a_time_of_day_mission_time_0_is_then(run: Run, flying) -> None:
    world, to = flying(hop_plan())
    at = world.clock.utc() + 60.0
    clock = datetime.fromtimestamp(at, UTC).isoformat()
    done = run("stream", "plan.json", *to, "--at", clock, "--arm")
    assert done.code == 0
    assert "mission time 0 is at" in done.err
    first = world.autopilots["cam1"].setpoints[0][0]  # before that, nothing but heartbeats
    assert first - (at - EPOCH) == pytest.approx(-8.0, abs=0.05)


def test_a_time_of_day_that_is_too_soon_or_over_arms_nothing(run: Run, flying) -> None:
    world, to = flying(hop_plan())
    soon = datetime.fromtimestamp(world.clock.utc() + 5.0, UTC).isoformat()
    done = run("stream", "plan.json", *to, "--at", soon, "--arm")
    assert done.code == 1
    assert "error[A035]" in done.err
    assert not world.autopilots["cam1"].setpoints
    assert {command[1] for command in world.autopilots["cam1"].commands} <= {511}
    for wrong in ("2020-01-01T00:00:00Z", "later"):
        assert run("stream", "plan.json", *to, "--at", wrong, "--arm").code == 2


def test_a_check_that_fails_is_told_and_ends_with_one(run: Run, flying) -> None:
    world, to = flying(hop_plan(), cam1=Script(parameters={"COM_OBL_RC_ACT": 0}))
    done = run("stream", "plan.json", *to, "--arm")
    assert done.code == 1
    assert "error[A007]" in done.err
    assert done.out == ""
    assert not world.autopilots["cam1"].setpoints


def test_interrupted_it_ends_as_interrupted_and_says_who_is_in_the_air(run: Run, flying) -> None:
    def stop():
        raise KeyboardInterrupt

    world, to = flying(hop_plan())
    world.clock.events.append((world.clock.time + 22.0, stop))
    done = run("stream", "plan.json", *to, "--arm")
    assert done.code == 130
    assert "in the air, HOLD was requested: take it over; left alone it will return (NAV_DLL_ACT)" in done.out


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="the system has no such signal")
@pytest.mark.parametrize("ending", ["SIGTERM", "SIGHUP"])
def test_ended_from_outside_the_drones_hold(run: Run, flying, ending) -> None:
    number = getattr(signal, ending)
    before = signal.getsignal(number)
    world, to = flying(hop_plan())
    world.clock.events.append((world.clock.time + 22.0, lambda: signal.raise_signal(number)))
    assert run("stream", "plan.json", *to, "--arm").code == 130
    assert world.autopilots["cam1"].mode == PX4_HOLD
    assert signal.getsignal(number) is before


def test_a_show_is_not_streamed(run: Run, monkeypatch) -> None:
    report = SimpleNamespace(plan=show_plan(), diagnostics=(), sources={})
    monkeypatch.setattr("shotc.cli.stream.prove", lambda _path: report)
    done = run("stream", "plan.json")
    assert done.code == 1
    assert "error[A030]" in done.err


def test_of_a_show_that_is_filmed_the_cameras_are_streamed() -> None:
    filmed = replace(
        hop_plan(), trajectory=replace(hop_plan().trajectory, fleets=show_plan().trajectory.fleets)
    )
    told = list(unplaced(filmed.trajectory.keyframes.mission, filmed))
    assert [d.code for d in told] == ["A034"]
    assert not has_errors(told)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--to", "14540"], "no address"),
        (["--to", "udp:14540"], "write `--to DRONE=...` for each"),
        (["--to", "near=udp:14540"], "no address for far"),
        (["--to", "neer=udp:14540"], "did you mean `near`"),
        (["--to", "near=udp:14540", "--to", "near=udp:14541"], "given twice"),
        (["--to", "near=udp:1", "--to", "far=udp:2", "--target", "udp:3"], "names no target"),
        (["--to", "near=udp:1", "--to", "far=udp:2", "--target", "towr=udp:3"], "did you mean `tower`"),
        (["--to", "near=udp:1", "--to", "far=udp:2", "--target", "shed=udp:3"], "no shot films `shed`"),
        ([], "no address for near, far"),
    ],
)
def test_addresses_are_read_before_anything_is_opened(run: Run, flying, words, said) -> None:
    flying(with_target(hop_plan("near", "far"), "shed"))
    done = run("stream", "plan.json", *words)
    assert done.code == 2
    assert said in " ".join(done.err.split())


def test_without_mavlink_the_extra_is_named(run: Run, flying, monkeypatch) -> None:
    _, to = flying(hop_plan())
    monkeypatch.setattr("shotc.cli.stream.find_spec", lambda name: None)
    done = run("stream", "plan.json", *to)
    assert done.code == 1
    assert "error[P004]" in done.err
    assert "[stream]" in done.err


def test_a_plan_that_cannot_be_read_is_told(run: Run) -> None:
    done = run("stream", "nowhere.json", "--to", f"udp:{free_port()}")
    assert done.code == 1
    assert "cannot be read" in done.err
