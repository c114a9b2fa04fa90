"""Makes the bodies of a picture's frames from its source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shotc.ir.show import Drawing, Lettering, Model, Picture, RecordedFlight
from shotc.show.goals.body import PlacedShape, SourceFault
from shotc.show.goals.drawing import drawing_body
from shotc.show.goals.frames import model_bodies
from shotc.show.goals.lettering import lettering_body
from shotc.show.goals.solids import solid_body


def bodies_of(picture: Picture, files: Mapping[str, bytes]) -> Sequence[PlacedShape] | SourceFault:
    """Return one body for each frame of a picture, or the reason why its source cannot be drawn.

    files : content of the mission's files by name, including all that the source names
    """
    source = picture.source
    if isinstance(source, Model):
        assert picture.fill != "legible"  # only texts have it
        return model_bodies(source, files, picture.fill)
    if isinstance(source, Drawing):
        body: PlacedShape | SourceFault = drawing_body(source, files[source.file])
    elif isinstance(source, Lettering):
        body = lettering_body(source, files)
    else:
        assert not isinstance(source, RecordedFlight)  # it has tracks, not a shape
        body = solid_body(source)
    return body if isinstance(body, SourceFault) else [body]
