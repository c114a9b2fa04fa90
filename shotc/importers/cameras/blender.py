"""Read a camera's animation from Blender as a table, one row per frame. The first line names the columns.

There is no standard for such tables. Columns: ``frame``, or ``time`` in seconds; ``x``, ``y``, ``z``; Euler
angles ``rx``, ``ry``, ``rz`` of order XYZ, or a quaternion ``qw``, ``qx``, ``qy``, ``qz``. The lens is
optional: ``hfov`` in degrees, or ``lens`` and ``sensor`` in millimetres. A camera of Blender looks along its
own -Z with Y up, in a world whose Z is up: x, y, z are East, North and Up.
"""

from __future__ import annotations

from math import asin, atan2, cos, degrees, hypot, pi, radians, sin

from shotc.geom.focal import field_of_view
from shotc.geom.vec import Vec3
from shotc.importers.cameras.places import clamped_hfov, level, reached, without_far
from shotc.importers.cameras.table import CameraTable, TableRow, table_of
from shotc.importers.cameras.takes import (
    MOST_CAMERAS,
    ImportedCamera,
    ImportedTakes,
    ImportOptions,
    Refused,
    Take,
)
from shotc.importers.notes import Notes
from shotc.importers.words import cut_into

USUAL_FPS = 24.0
USUAL_LENS_MM, USUAL_SENSOR_MM = 50.0, 36.0  # millimetres; the values of a new camera in Blender
EXAMPLE = "frame,x,y,z,rx,ry,rz,lens"
NAMES = {
    "frame": ("frame", "frames"),
    "time": ("time", "t", "time_s", "t_s"),
    **{k: (k, f"t{k}", f"loc_{k}", f"location_{k}", f"pos_{k}", f"{k}_m") for k in "xyz"},
    **{
        f"r{k}": (f"r{k}", f"rot_{k}", f"e{k}", f"euler_{k}", f"rotation_{k}", f"rotation_euler_{k}")
        for k in "xyz"
    },
    **{f"q{k}": (f"q{k}", f"quat_{k}", f"quaternion_{k}", f"rotation_quaternion_{k}") for k in "wxyz"},
    "lens": ("lens", "focal_length", "focal", "lens_mm", "focal_mm"),
    "hfov": ("hfov", "fov_x", "angle_x"),
    "sensor": ("sensor", "sensor_width", "sensor_mm"),
}
"""Accepted names of the columns. Names of angles may end in ``_deg`` or ``_rad``."""
LEVEL_AXIS_SHARE = 1e-6
"""Least horizontal part of the view direction. Below it, the camera's up axis gives the heading."""


def footage(text: str, options: ImportOptions, notes: Notes) -> ImportedTakes | Refused:
    """Return the single take of a table of frames."""
    table = table_of(text, [NAMES[k] for k in "xyz"], EXAMPLE)
    if isinstance(table, Refused):
        return table
    columns = {key: name for key, names in NAMES.items() if (name := _column(table, names))}
    turned = [k for k in ("qw", "qx", "qy", "qz", "rx", "ry", "rz") if k in columns]
    if not {"rx", "ry", "rz"} <= set(turned) and not {"qw", "qx", "qy", "qz"} <= set(turned):
        message = "it has neither the columns `rx`, `ry`, `rz` nor `qw`, `qx`, `qy`, `qz`"
        return Refused("I002", message, table.node, f"begin it with a line such as `{EXAMPLE}`")
    if "frame" not in columns and "time" not in columns:
        message = "it has no column `frame`, nor `time`"
        return Refused("I002", message, table.node, f"begin it with a line such as `{EXAMPLE}`")
    if len(table.rows) > MOST_CAMERAS:
        message = f"it has {len(table.rows)} frames; at most {MOST_CAMERAS} are read"
        return Refused("I001", message, table.rows[MOST_CAMERAS].node, cut_into(MOST_CAMERAS, "frames"))
    cameras = _cameras(table, columns, options, notes)
    return ImportedTakes(table.node, without_far([Take("", table.node, tuple(cameras))], notes))


def _column(table: CameraTable, names: tuple[str, ...]) -> str:
    """Return the name of a column in a table, empty if the table does not have it."""
    endings = ("", "_deg", "_rad")
    return next((n + end for n in names for end in endings if n + end in table.heads), "")


def _cameras(
    table: CameraTable, columns: dict[str, str], options: ImportOptions, notes: Notes
) -> list[ImportedCamera]:
    rate = _rate(table, columns, options, notes)
    unit = _unit(table, columns, notes)
    _lens_noted(table, columns, notes)
    cameras: list[ImportedCamera] = []
    first = 0.0
    for row in table.rows:
        values = {key: row.number(name, notes) for key, name in columns.items()}
        clock = values.get("time") if "time" in columns else values.get("frame")
        camera = None if clock is None else _camera(row, values, unit, notes)
        if camera is None or clock is None:
            notes.assume(row.node, "a row that lacks a number", "it is left out")
            continue
        seconds = clock / rate if "time" not in columns else clock
        first = first if cameras else seconds
        if cameras and seconds - first <= (cameras[-1].time or 0.0):
            notes.assume(row.node, "a row that is no later than the one before", "it is left out")
            continue
        cameras.append(camera._replace(time=seconds - first))
    return cameras


def _rate(table: CameraTable, columns: dict[str, str], options: ImportOptions, notes: Notes) -> float:
    if "time" in columns or options.fps is not None:
        return options.fps or USUAL_FPS
    head = table.heads[columns["frame"]]
    notes.assume(head, "the file does not say how long a frame is", f"{USUAL_FPS:g} frames a second; `--fps`")
    return USUAL_FPS


def _unit(table: CameraTable, columns: dict[str, str], notes: Notes) -> float:
    """Return the unit of the table's angles in radians. Some tables have degrees, as Blender shows."""
    name = columns.get("rx", "")
    if not name or "qw" in columns:
        return 1.0
    if name.endswith(("_deg", "_rad")):
        return radians(1.0) if name.endswith("_deg") else 1.0
    unheard = Notes()
    angles = [row.number(columns[k], unheard) or 0.0 for row in table.rows for k in ("rx", "ry")]
    in_degrees = max(map(abs, angles), default=0.0) > 2 * pi
    taken = "degrees" if in_degrees else "radians"
    message = f"the file does not say in which unit `{name}` is"
    notes.assume(table.heads[name], message, f"{taken}; `rx_deg` or `rx_rad` says it")
    return radians(1.0) if in_degrees else 1.0


def _lens_noted(table: CameraTable, columns: dict[str, str], notes: Notes) -> None:
    if "lens" not in columns and "hfov" not in columns:
        taken = (
            f"{USUAL_LENS_MM:g} mm on a sensor {USUAL_SENSOR_MM:g} mm wide, as a new camera of Blender has"
        )
        notes.assume(table.node, "the file has no column `hfov`, nor `lens`", taken)


def _camera(
    row: TableRow, values: dict[str, float | None], unit: float, notes: Notes
) -> ImportedCamera | None:
    x, y, z = (values.get(k) for k in "xyz")
    axes = _axes(values, unit)
    if x is None or y is None or z is None or axes is None:
        return None
    forward, up, right = axes
    pitch = degrees(asin(max(-1.0, min(1.0, forward[2]))))
    flat = (
        forward
        if hypot(forward[0], forward[1]) > LEVEL_AXIS_SHARE
        else _times(up, -1.0 if forward[2] > 0 else 1.0)
    )
    level(row.node, degrees(asin(max(-1.0, min(1.0, right[2])))), notes)
    heading = degrees(atan2(flat[0], flat[1])) % 360.0
    return ImportedCamera(row.node, (x, y, z), heading, reached(row.node, pitch, notes), _hfov(values))


def _hfov(values: dict[str, float | None]) -> float:
    """Return the horizontal field of view of a landscape frame, degrees."""
    hfov = values.get("hfov")
    if hfov is None:
        lens, sensor = values.get("lens") or USUAL_LENS_MM, values.get("sensor") or USUAL_SENSOR_MM
        hfov = degrees(field_of_view(max(lens, 1e-3), sensor))
    return clamped_hfov(hfov)


def _axes(values: dict[str, float | None], unit: float) -> tuple[Vec3, Vec3, Vec3] | None:
    """Return the unit vectors forward, up and right of a camera; None without a rotation."""
    w, x, y, z = (values.get(f"q{k}") for k in "wxyz")
    if w is None or x is None or y is None or z is None:
        angles = [values.get(f"r{k}") for k in "xyz"]
        if None in angles:
            return None
        ex, ey, ez = (unit * (angle or 0.0) / 2 for angle in angles)
        a, b, c = (cos(ex), sin(ex)), (cos(ey), sin(ey)), (cos(ez), sin(ez))
        w = a[0] * b[0] * c[0] + a[1] * b[1] * c[1]  # Rz Ry Rx
        x = a[1] * b[0] * c[0] - a[0] * b[1] * c[1]
        y = a[0] * b[1] * c[0] + a[1] * b[0] * c[1]
        z = a[0] * b[0] * c[1] - a[1] * b[1] * c[0]
    size = hypot(w, x, y, z)
    if not size > 1e-6:
        return None
    w, x, y, z = w / size, x / size, y / size, z / size
    right = (1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w))
    up = (2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w))
    back = (2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y))
    return _times(back, -1.0), up, right


def _times(a: Vec3, by: float) -> Vec3:
    return (a[0] * by, a[1] * by, a[2] * by)
