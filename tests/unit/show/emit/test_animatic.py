"""The animatic, read back by Pillow: where lights are, how they shine, and how long it plays."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from shotc.show.emit.animatic import EMITTER
from shotc.show.emit.animatic.film import HEIGHT_PX, MOST_FRAMES, WIDTH_PX
from tests.support import show_flights
from tests.support.film_plans import orbit_plan


@pytest.mark.long
def test_it_plays_the_show_at_its_own_pace() -> None:
    plan = show_flights.plan()
    (file,) = EMITTER.emit(plan).artifacts
    assert file.name == "animatic.gif"
    assert len(file.data) < 3_000_000
    with Image.open(BytesIO(file.data)) as film:
        assert film.size == (WIDTH_PX, HEIGHT_PX)
        assert film.info["loop"] == 0
        assert film.n_frames <= MOST_FRAMES  # type: ignore[attr-defined]
        frames, ends = [], [24.0]
        for k in range(film.n_frames):  # type: ignore[attr-defined]
            film.seek(k)
            frames.append(np.asarray(film.convert("RGB")).astype(int)[: HEIGHT_PX - 20])
            ends.append(ends[-1] + film.info["duration"] / 1000.0)
    # Lights come on at 24 s, and are out at 44 s.
    assert ends[-1] == pytest.approx(44.0, abs=0.3)
    times = {"orange": 27.0, "blue": 41.0}
    seen = {name: frames[int(np.searchsorted(ends, time)) - 1] for name, time in times.items()}
    for name, picture in seen.items():
        lights = picture[picture.max(axis=2) > 120]
        assert len(lights) > 100, name
        red, _, blue = lights.mean(axis=0)
        assert (red > 2 * blue) if name == "orange" else (blue > 2 * red)
    assert EMITTER.emit(plan).artifacts == (file,)


def test_no_fleet_no_film() -> None:
    emission = EMITTER.emit(orbit_plan())
    assert emission.artifacts == ()
    assert len(emission.notes) == 1
