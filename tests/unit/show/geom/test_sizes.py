"""Pictures of other sizes: every size alike, and a model without one as it is."""

from __future__ import annotations

import pytest

from shotc.ir.show import Box, Model, RecordedFlight, Source, Sphere, Torus
from shotc.show.geom.sizes import larger, resized, size_words

MIDDLE = (0.0, 0.0, 40.0)
MODEL = Model(("a.ply",), None, MIDDLE, 8.0, 0.0)


@pytest.mark.parametrize(
    ("source", "twice"),
    [
        (Sphere(MIDDLE, 5.0), Sphere(MIDDLE, 10.0)),
        (Torus(MIDDLE, 5.0, 1.5, 0.0, 0.5), Torus(MIDDLE, 10.0, 3.0, 0.0, 0.5)),
        (Box(MIDDLE, (2.0, 3.0, 4.0), 0.5), Box(MIDDLE, (4.0, 6.0, 8.0), 0.5)),
        (MODEL, MODEL._replace(height=16.0)),
        (MODEL._replace(height=None), MODEL._replace(height=None)),
    ],
)
def test_all_sizes_are_changed_alike(source: Source, twice: Source) -> None:
    assert resized(source, lambda metres: 2.0 * metres) == twice


def test_a_model_without_a_height_is_larger_than_it_is_now() -> None:
    assert larger(MODEL._replace(height=None), 1.5, tall=4.0) == MODEL._replace(height=6.0)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (Sphere(MIDDLE, 5.0), "radius: 5.0"),
        (Torus(MIDDLE, 5.0, 1.5, 0.0, 0.5), "radius: 5.0, tube: 1.5"),
        (Box(MIDDLE, (2.0, 3.0, 4.0), 0.5), "size: 2.0"),
        (MODEL, "height: 8.0"),
    ],
)
def test_a_size_is_told_in_the_words_of_the_language(source: Source, words: str) -> None:
    assert size_words(source, source) == words
    assert size_words(source, source._replace(centre=(0.0, 1.5, 42.0))) == f"{words}, center: [0, 1.5, 42]"


def test_a_recorded_flight_has_no_size() -> None:
    flight = RecordedFlight("show.zip")
    assert size_words(flight, flight) == ""
    assert resized(flight, lambda metres: 2.0 * metres) is flight
