"""Helps about recorded flights of fleets: the file, or the fleet, is changed as they say."""

from __future__ import annotations

from pathlib import Path

import pytest

from shotc.diag.model import Diagnostic
from tests.support.flight_files import zipped
from tests.support.recorded_shows import COUNT, csv_show, flown, planned, tables

pytestmark = [pytest.mark.slow, pytest.mark.long]


def told(folder: Path, data: bytes, **changes: object) -> dict[str, Diagnostic]:
    return {d.code: d for d in planned(folder, "show.zip", data, **changes).diagnostics}


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Diagnostic]:
    """Return what a show tells that is slow enough, and goes straight up over its pads."""
    return told(tmp_path_factory.mktemp("good"), csv_show(flown(60.0), 60.0))


def test_a_file_that_is_exported_again_is_read(tmp_path: Path, good: dict[str, Diagnostic]) -> None:
    broken = tables(flown())
    name = next(iter(broken))
    broken[name] = broken[name].replace(b"\n250,", b"\nsoon,", 1)
    assert "a number" in (told(tmp_path, zipped(broken))["D150"].help or "")
    assert good == {}


def test_a_fleet_of_as_many_drones_as_there_are_tracks_flies(
    tmp_path: Path, good: dict[str, Diagnostic]
) -> None:
    refused = told(tmp_path, csv_show(flown()), count=COUNT + 1)["D151"]
    assert f"write `count: {COUNT}`, with as many pads" in (refused.help or "")
    fewer = dict(list(tables(flown()).items())[:-1])
    refused = told(tmp_path, zipped(fewer))["D151"]
    assert f"give a file with {COUNT} tracks" in (refused.help or "")
    assert good == {}


def test_a_slower_show_ends_d154(tmp_path: Path, good: dict[str, Diagnostic]) -> None:
    refused = told(tmp_path, csv_show(flown(12.0), 12.0))["D154"]
    assert "make the show slower where it was made" in (refused.help or "")
    assert good == {}


def test_drones_that_go_straight_up_end_d155(tmp_path: Path, good: dict[str, Diagnostic]) -> None:
    refused = told(tmp_path, csv_show(flown(60.0, lean=6.0), 60.0))["D155"]
    assert "let all drones go straight up over their pads" in (refused.help or "")
    assert good == {}
