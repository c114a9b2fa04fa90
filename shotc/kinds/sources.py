"""Lowering of a display's pictures to MissionIR: positions in W, patterns as lists of files."""

from collections.abc import Sequence

from shotc.diag.model import Diagnostic
from shotc.ir.origin import KeyPath
from shotc.ir.show import Box, Drawing, Lettering, Model, Picture, RecordedFlight, Source, Sphere, Torus, Wave
from shotc.kinds.base import Scene
from shotc.kinds.effect_stack import effects_of
from shotc.kinds.models.endings import FLIGHT_ENDINGS
from shotc.kinds.moments import moment
from shotc.kinds.pictures import DrawingSpec, FilesSpec, FlightSpec, PictureSpec, TextSpec, TransitionSpec

MESHES = (".ply", ".obj", ".stl", ".glb")
METRES = (".glb",)
"""Endings of formats that are in metres by definition."""
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "ft": 0.3048, "in": 0.0254}
FONTS = (".ttf", ".otf", ".ttc")
DRAWINGS = (".svg",)


def picture_of(
    spec: PictureSpec | FilesSpec | FlightSpec, scene: Scene, index: int
) -> Picture | list[Diagnostic]:
    """Return one picture of a display, or its faults; of its source only the first one.

    spec : a picture, or the files or the flight that a display has instead of a list of pictures
    """
    path: KeyPath = (*scene.path, "frames")
    if isinstance(spec, FlightSpec):
        strange = _unreadable(
            scene, [spec.flight], FLIGHT_ENDINGS, "the flight of a fleet", (*path, "flight")
        )
        flown = Picture(RecordedFlight(spec.flight), "volume", None, None, 0.0, path)
        return flown if strange is None else [strange]
    if isinstance(spec, FilesSpec):
        alone = _model(spec, scene, path)
        return [alone] if isinstance(alone, Diagnostic) else Picture(alone, "volume", None, None, 0.0, path)
    path = (*scene.path, "frames", index)
    source = _drawable(spec, scene, path)
    at = None if spec.at is None else moment(spec.at, scene, (*path, "at"))
    effects = effects_of(spec.effects, scene, (*path, "effects"))
    change = spec.transition or TransitionSpec()
    wave = _wave(change, scene, (*path, "transition"))
    if (
        isinstance(source, Diagnostic)
        or isinstance(at, Diagnostic)
        or isinstance(wave, Diagnostic)
        or isinstance(effects, list)
    ):
        wrong = [one for one in (source, at, wave) if isinstance(one, Diagnostic)]
        return [*wrong, *(effects if isinstance(effects, list) else ())]
    fill = spec.fill or ("legible" if isinstance(source, Lettering) else "volume")
    picture = Picture(source, fill, spec.color, change.duration, spec.hold, path, change.path, spec.layers)
    picture = picture._replace(at=at, name=spec.name, size=spec.size, effects=effects)
    return picture._replace(easing=change.easing, wave=wave)


def _wave(spec: TransitionSpec, scene: Scene, path: KeyPath) -> Wave | Diagnostic | None:
    """Return the wave of a transition, or its fault; path : of the transition."""
    wave = spec.wave
    if wave is None:
        return None
    if spec.path == "arc":
        labels = (scene.origins.value((*path, "path")), scene.origins.key((*path, "wave"), "the wave"))
        note = "on arcs drones keep apart because all are as far along them at any time"
        help_ = "write `path: straight`, or leave `wave` out"
        return Diagnostic("D140", "a wave goes on straight lines, not on arcs", labels, (note,), help_)
    center = None if wave.center is None else scene.place(wave.center)
    return Wave(wave.time, wave.along, wave.by, center)


def _drawable(spec: PictureSpec, scene: Scene, path: KeyPath) -> Source | Diagnostic:
    """Return the source of a picture, or a fault if it cannot have the given fill or layers."""
    source = _source(spec, scene, path)
    if isinstance(source, Diagnostic):
        return source
    if spec.fill == "outline" and not isinstance(source, Lettering | Drawing | Box):
        label = scene.origins.value((*path, "fill"))
        note = "only `text`, `svg` and `cube` have edges to stand on"
        help_ = "write `fill: surface`, or remove it"
        return Diagnostic("D009", "this picture has no outline", (label,), (note,), help_)
    if spec.layers > 1 and not isinstance(source, Lettering | Drawing):
        label = scene.origins.value((*path, "layers"))
        note = "only `text` and `svg` are flat"
        return Diagnostic("D026", "this picture has no layers", (label,), (note,), "remove `layers`")
    return source


def _source(spec: PictureSpec, scene: Scene, path: KeyPath) -> Source | Diagnostic:
    """Return the source of a picture; its model ensures that there is exactly one."""
    if spec.sphere is not None:
        return Sphere(scene.place(spec.sphere.center), spec.sphere.radius)
    if spec.cube is not None:
        cube = spec.cube
        return Box(scene.place(cube.center), (cube.size, cube.size, cube.size), cube.heading)
    if spec.torus is not None:
        ring = spec.torus
        return Torus(scene.place(ring.center), ring.radius, ring.tube, ring.heading, ring.tilt)
    if spec.text is not None:
        return _lettering(spec.text, scene, (*path, "text"))
    if spec.svg is not None:
        return _drawing(spec.svg, scene, (*path, "svg"))
    assert spec.model is not None
    return _model(spec.model, scene, (*path, "model"))


def _lettering(spec: TextSpec, scene: Scene, path: KeyPath) -> Lettering | Diagnostic:
    font = spec.font
    if font is not None and "." in font:  # a file, because names of fonts have no ending
        wrong = _unreadable(scene, [font], FONTS, "a font", (*path, "font"))
        if wrong is not None:
            return wrong
    return Lettering(spec.text, scene.place(spec.center), spec.height, spec.heading, font)


def _drawing(spec: DrawingSpec, scene: Scene, path: KeyPath) -> Drawing | Diagnostic:
    wrong = _unreadable(scene, [spec.file], DRAWINGS, "a drawing", (*path, "file"))
    return wrong or Drawing(spec.file, scene.place(spec.center), spec.height, spec.heading)


def _model(spec: FilesSpec, scene: Scene, path: KeyPath) -> Model | Diagnostic:
    where = (*path, "files")
    names = scene.match(spec.files, where)
    if isinstance(names, Diagnostic):
        return names
    wrong = _unreadable(scene, names, MESHES, "a mesh or point cloud", where)
    if wrong is not None:
        return wrong
    if len(names) > 1 and spec.period is None:
        note = f"`{spec.files}` matches {len(names)} files, `{names[0]}` to `{names[-1]}`"
        label = scene.origins.value(where)
        return Diagnostic(
            "D010", "this animation has no period", (label,), (note,), "add a period, such as `period: 1 s`"
        )
    if spec.units is None and spec.height is None:
        silent = next((name for name in names if not name.lower().endswith(METRES)), None)
        if silent is not None:
            return _without_units(scene, silent, where)
    centre = None if spec.center is None else scene.place(spec.center)
    unit = UNITS[spec.units or "m"]
    return Model(names, spec.period, centre, spec.height, spec.heading, unit, spec.up)


def _without_units(scene: Scene, name: str, path: KeyPath) -> Diagnostic:
    """Return the diagnostic of a model without units or height."""
    return Diagnostic(
        "D025",
        f"nothing says how large `{name}` is",
        (scene.origins.value(path),),
        (f"{name.rsplit('.', 1)[-1].upper()} files have numbers without a unit",),
        "add `units: m` (or cm, mm, ft, in), or `height`, how tall the first frame is to be",
    )


def _unreadable(
    scene: Scene, names: Sequence[str], endings: Sequence[str], what: str, path: KeyPath
) -> Diagnostic | None:
    """Return the diagnostic of the first file with an ending of another format, or None."""
    strange = next((name for name in names if not name.lower().endswith(tuple(endings))), None)
    if strange is None:
        return None
    message = f"`{strange}` is in no format that {what} is read from"
    label = scene.origins.value(path)
    *most, last = endings
    known = f"{', '.join(most)} or {last}" if most else last
    return Diagnostic("D011", message, (label,), help=f"give a file that ends in {known}")
