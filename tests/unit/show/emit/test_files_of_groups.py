"""Files of a fleet with groups: the same drones, names and numbers as of the fleet without them."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from zipfile import ZipFile

from shotc.emit import csv_table
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit import skyc, vviz, zipped_csv
from tests.support.grouped_plans import grouped
from tests.support.show_plans import plan

WHOLE, PARTS = plan(), plan(grouped())


def viewed(made: VerifiedIR) -> list[dict[str, object]]:
    (file,) = vviz.EMITTER.emit(made).artifacts
    return list(json.loads(file.data)["performances"])


def shown(made: VerifiedIR) -> list[dict[str, object]]:
    (file,) = skyc.EMITTER.emit(made).artifacts
    return list(json.loads(ZipFile(io.BytesIO(file.data)).read("show.json"))["swarm"]["drones"])


def zipped(made: VerifiedIR) -> bytes:
    (file,) = zipped_csv.EMITTER.emit(made).artifacts
    return file.data


def table(made: VerifiedIR) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(csv_table.EMITTER.emit(made).artifacts[0].data.decode())))


def test_groups_fly_what_the_fleet_flies_drone_by_drone_in_every_file() -> None:
    # The flights are the same, so whoever numbers or orders drones by groups writes other bytes.
    assert zipped(PARTS) == zipped(WHOLE)
    assert viewed(PARTS) == viewed(WHOLE)
    assert shown(PARTS) == shown(WHOLE)
    rows, whole = table(PARTS), table(WHOLE)
    assert [{**row, "shot": ""} for row in rows] == [{**row, "shot": ""} for row in whole]
    assert {row["shot"] for row in rows if row["drone"] == "swarm-2"} == {"", "globe1"}


def test_who_stays_on_its_pad_leaves_a_gap_in_the_numbers_and_moves_nobody_else() -> None:
    asked = grouped()
    flown = replace(
        PARTS.trajectory,
        keyframes=KeyframeIR(asked._replace(displays=asked.displays[1:]), ()),
        fleets=PARTS.trajectory.fleets[1:],
    )
    alone = replace(PARTS, trajectory=flown)
    assert [drone["id"] for drone in viewed(alone)] == [2, 3]
    assert viewed(alone) == viewed(WHOLE)[1:3]
    assert shown(alone) == shown(WHOLE)[1:3]
