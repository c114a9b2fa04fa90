"""Every code has its help tried literally, or stands in one of two lists that may only get shorter."""

from __future__ import annotations

from importlib import import_module

import pytest

from shotc.diag.registry import registry
from tests.remedies import (
    test_films,
    test_imported,
    test_judged_flights,
    test_other_codes,
    test_texts,
    test_with_show_files,
    test_written_files,
)
from tests.support.remedies import with_files

TABLES = (
    test_films,
    test_imported,
    test_judged_flights,
    test_other_codes,
    test_texts,
    test_with_show_files,
    test_written_files,
    with_files,
)
"""Modules whose cases each name the code that they try."""

HERE = {
    **dict.fromkeys(("I001", "I002", "I003", "I008", "I009", "I010", "I011"), "test_refused_files"),
    **dict.fromkeys(("I013", "I014"), "test_judged_flights"),
    **dict.fromkeys(("A001", "A031", "A033"), "test_streamed"),
    **dict.fromkeys(("N010", "Y005"), "test_texts"),
    **dict.fromkeys(("D126", "D127", "E150"), "test_songs"),
    **dict.fromkeys(("D150", "D151", "D154", "D155"), "test_recorded_flights"),
    **dict.fromkeys(("W003", "W004"), "test_rehearsed"),
}
"""Codes that tests of this folder try without a table that names them."""

DEVIATIONS = "tests.unit.simulation.test_deviations"
ELSEWHERE = {
    "I012": "tests.unit.flightfiles.test_bad_files:test_the_good_ones_are_good",
    "W001": "tests.cli.test_simulate:test_what_the_help_proposes_is_kept",
    "W008": f"{DEVIATIONS}:test_the_proposed_speed_and_the_true_track_end_the_warning",
}
"""Codes whose help a test beside others tries."""

NO_EDIT = {
    **dict.fromkeys(
        [f"A{n:03}" for n in (*range(2, 14), *range(20, 30))],
        "it says what to do at a vehicle, its link or its parameters",
    ),
    **dict.fromkeys(
        ("P001", "P002", "P003", "P004", "P005", "P007", "N013", "E201", "E202", "E203"),
        "it says what to install, or where to run",
    ),
    **dict.fromkeys(("W006", "W007", "E901", "Y022", "N011", "N012"), "it is about a machine and its files"),
    **dict.fromkeys(
        ("P008", "R001", "R002", "R004", "R005", "W010", "E902"), "it is reported to a plugin's authors"
    ),
    **dict.fromkeys(("X001", "Q008"), "it is our fault, to be reported"),
    **dict.fromkeys(
        ("V011", "V012", "V014", "V015", "V016", "V017", "V018", "V024", "V040", "V041", "V042", "V043",
            "V044", "V045", "V046", "V064", "V065", "V066", "E001", "E002", "E003"),
        "a plan was edited or broken; it says to plan again",
    ),
    **dict.fromkeys(("I004", "I005"), "the import says what it took instead, in the mission that it writes"),
    **dict.fromkeys(("A014", "A035"), "it says what to set on a vehicle, or by an option"),
    **dict.fromkeys(("A030", "A032", "A034"), "it names the command that writes another file"),
    **dict.fromkeys(("I006", "E114"), "it points at the faults above, whose own helps are tried"),
    "W011": "it says what to read about an autopilot",
}  # fmt: skip
"""Codes whose help no edit of a mission or file does, and why."""

UNTRIED = frozenset((
    "D053", "D059", "D060", "D084", "D085", "D086", "D088", "D099", "D102",
    "D152", "D153", "D156",
    "E103", "E104", "E106", "E112", "E113", "E115", "E119",
    "G029", "G052",
    "M010",
    "N017", "N018", "N019",
    "P006",
    "Q003", "Q004",
    "R003", "R006", "R007", "R008", "R009", "R010", "R011", "R012", "R013", "R014",
    "T006",
    "V002", "V003", "V004", "V005", "V006", "V013", "V031", "V032", "V052",
    "V053", "V054", "V055", "V056", "V057", "V060", "V063",
    "W002", "W009",
    "Y003", "Y023",
))  # fmt: skip
"""Codes whose help is an edit, and that no test tries yet."""


def tried() -> set[str]:
    """Return the codes whose help is tried."""
    shown = {info.code for info in registry().values() if info.phase in ("check", "plan")}
    listed = {case.code for table in TABLES for case in table.CASES}
    text = {info.code for info in registry().values() if info.code.startswith("Y")}
    return (shown - text) | listed | set(HERE) | set(ELSEWHERE)


def test_each_code_is_tried_or_listed_once() -> None:
    known, listed = set(registry()), (set(NO_EDIT), set(UNTRIED))
    assert tried() | set().union(*listed) == known
    assert not (tried() & set().union(*listed))
    assert not (listed[0] & listed[1])


@pytest.mark.slow
def test_the_tests_beside_others_are_there() -> None:
    for place in ELSEWHERE.values():
        module, _, name = place.partition(":")
        assert callable(getattr(import_module(module), name))
