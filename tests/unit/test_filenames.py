"""Names of files that are made of the names of missions."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.filenames import MAX_BYTES, file_name
from shotc.spec.places import TITLE


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("tower-reveal", "tower-reveal"),
        ("take_2.final", "take_2.final"),
        ("Zürich See 2", "Zürich-See-2"),
        ("Bob's (final) cut", "Bob-s-final-cut"),
        ("con", "mission-con"),
        ("!!!", "mission"),
    ],
)
def test_a_title_gives_a_name(title, name):
    assert file_name(title) == name


@pytest.mark.slow
@given(st.text(min_size=1))
def test_no_name_leaves_its_folder_or_is_too_long_for_a_file_system(title):
    name = file_name(title)
    assert name
    assert re.fullmatch(r"[\w.-]+", name)
    assert not name.startswith((".", "-"))
    assert len(name.encode()) <= MAX_BYTES + len("mission-")


@pytest.mark.parametrize("title", ["Zürich See", "塔の撮影", "Bob's cut, no. 2", "x" * 100])
def test_titles_of_any_script_with_spaces_are_names_of_missions(title):
    assert TITLE.read(title) == title


@pytest.mark.parametrize(
    "title", ["../look", "a/b", "a:b", " a", "a ", ".a", "-a", "a\u202eb", "a\tb", "", "x" * 101]
)
def test_what_reads_as_a_path_or_hides_text_is_refused(title):
    assert re.fullmatch(TITLE.pattern, title) is None
