"""The show over the lake: what its pictures show while they are held."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from tests.support import show_files
from tests.support.lakeside_show import COLORS, DIGITS, LIGHT, Show, asked, held

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("shows")]

MIDDLE = np.array([0.0, 20.0, 50.0])


@pytest.mark.long
def test_pictures_stand_still_in_their_colours(show: Show) -> None:
    for (picture, places, lights), color in zip(held(show), COLORS, strict=True):
        assert np.ptp(places, axis=1).max() < DIGITS, picture
        assert (lights == color).all(), picture
    on_pads = np.isin(show.rows["t_s"][0], [0.0, show.rows["t_s"][0, -1]])
    assert (show.rows[LIGHT][:, on_pads] == 0).all()


def test_every_picture_is_where_it_is_asked_for(show: Show) -> None:
    stood = {next(iter(picture)): places[:, 0] - MIDDLE for picture, places, _ in held(show)}
    assert list(stood) == ["sphere", "cube", "torus", "svg", "text"]
    spaced = np.sqrt(2) * asked(show)[0]
    for name, places in stood.items():
        # Goals are moved for their spacing by less than it.
        assert off(name, places).max() < spaced, name
        assert (off(name, places) < 0.1).mean() > 0.5, name
        least = show_files.nearest(places[None], show.fleet.asked["apart"])[0]
        assert least >= np.sqrt(2) - 1e-5, name


def off(name: str, places: Array) -> Array:
    """How far places about the middle are from what they draw, metres."""
    x, y, z = places.T
    if name == "sphere":
        return np.maximum(np.linalg.norm(places, axis=1) - 18, 0)
    if name == "cube":
        east, north = np.cos(np.pi / 6), np.sin(np.pi / 6)
        corner = np.abs(np.stack([east * x - north * y, north * x + east * y, z], axis=1)) - 15
        return np.abs(np.linalg.norm(np.maximum(corner, 0), axis=1) + np.minimum(corner.max(axis=1), 0))
    if name == "torus":  # its axis lies to the north
        return np.maximum(np.hypot(np.hypot(x, z) - 20, y) - 6, 0)
    # Flat pictures: off their plane, and out of the box around them.
    # Of a text the dots of its U are part, which stand above the capitals by a quarter of their height.
    wide, high = {"svg": (20 * 96 / 86, 20), "text": (42, 27 * 1.25 / 2)}[name]
    return np.abs(y) + np.maximum(np.abs(x) - wide, 0) + np.maximum(np.abs(z) - high, 0)


def test_solids_are_filled_all_round(show: Show) -> None:
    stood = {next(iter(picture)): places[:, 0] - MIDDLE for picture, places, _ in held(show)}
    for name in ("sphere", "cube", "torus"):
        assert np.abs(stood[name].mean(axis=0)).max() < 1.0, name
    for name, reach in (("sphere", 15), ("cube", 14), ("torus", 22), ("svg", 18)):
        assert stood[name][:, 2].max() > reach, name
        assert stood[name][:, 2].min() < -reach, name
    # A ring has a hole, a surface is hollow, and a heart is wide above and pointed below.
    x, _, z = stood["torus"].T
    assert np.hypot(x, z).min() > 20 - 6 - 0.5
    assert np.linalg.norm(stood["cube"], axis=1).min() > 14
    x, _, z = stood["svg"].T
    assert np.ptp(x[z > 5]) > 3 * np.ptp(x[z < -14])
