"""Setpoints of a framing: the required appearance of a subject later in the shot."""

from collections.abc import Iterator
from typing import NamedTuple

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.setpoints import Setpoint, ViewAngles
from shotc.kinds.base import Scene
from shotc.spec.fields import Angle, Duration, Pitch, ScreenPoint, ShotSize
from shotc.spec.model import Model

WHAT = {"frame": "place on screen", "size": "size", "azimuth": "bearing", "elevation": "elevation"}


class ViewSpec(Model):
    """The side from which a subject is seen; an omitted key is free."""

    azimuth: Angle | None = Field(default=None, description="compass bearing from the subject to the camera")
    elevation: Pitch | None = Field(default=None, description="how high the camera stands above the subject")

    @property
    def angles(self) -> ViewAngles:
        """Azimuth and elevation, rad."""
        return (self.azimuth, self.elevation)


class SetpointSpec(Model):
    """The required appearance of a subject at a time of the shot; an omitted key does not change."""

    time: Duration = Field(description="when it appears so, from the shot's start")
    frame: ScreenPoint | None = Field(default=None, description="where on screen its centre is then")
    size: ShotSize | None = Field(
        default=None, description="projected height over frame height then, or the name of a shot size"
    )
    view: ViewSpec | None = Field(default=None, description="the side from which it is seen then")

    @property
    def written(self) -> tuple[tuple[str, ...], ...]:
        """The key paths, below the setpoint, of the values that it changes."""
        view = self.view or ViewSpec()
        values = {
            ("frame",): self.frame,
            ("size",): self.size,
            ("view", "azimuth"): view.azimuth,
            ("view", "elevation"): view.elevation,
        }
        return tuple(keys for keys, value in values.items() if value is not None)


def setpoints_of(specs: tuple[SetpointSpec, ...], scene: Scene, *path: str | int) -> tuple[Setpoint, ...]:
    """Return the setpoints of a subject; path : of their list, below the shot."""
    return tuple(
        Setpoint(
            spec.time,
            spec.frame,
            spec.size,
            None if spec.view is None else spec.view.angles,
            (*scene.path, *path, k, "time"),
        )
        for k, spec in enumerate(specs)
    )


def setpoint_faults(
    specs: tuple[SetpointSpec, ...],
    scene: Scene,
    subject: tuple[str, frozenset[str]],
    duration: float | None,
    *path: str | int,
) -> Iterator[Diagnostic]:
    """Yield faults of setpoints: out of order, after the end of the shot, or without an initial value.

    subject : its name, and the keys of ``WHAT`` that it has at first; path : of the list, below the shot
    """
    name, known = subject
    for k, spec in enumerate(specs):
        if not spec.written:
            message = f"this setpoint changes nothing of how `{name}` appears"
            yield scene.fault("M036", message, "give it `frame`, `size` or `view`", *path, k)
        for keys in spec.written:
            if keys[-1] not in known:
                message = f"this setpoint changes the {WHAT[keys[-1]]} of `{name}`, which has none at first"
                key = keys[0] if len(keys) == 1 else f"view: {{{keys[1]}: ...}}"
                help_ = f"write `{key}` beside `target`, too: what it is when the shot begins"
                yield scene.fault("M036", message, help_, *path, k, *keys)
    for k, spec in enumerate(specs):
        wrong = _out_of_time(spec.time, specs[k - 1].time if k else 0.0, duration)
        if wrong is not None:
            yield scene.fault("M037", wrong.message, wrong.help, *path, k, "time", notes=(wrong.note,))


class _Fault(NamedTuple):
    message: str
    note: str
    help: str


def _out_of_time(time: float, before: float, duration: float | None) -> _Fault | None:
    """Return the fault of the time of a setpoint; before : time of the one before."""
    if time <= before:
        note = f"it is at {time:g} s, the one before it at {before:g} s"
        return _Fault("the times of setpoints do not rise", note, f"set it later than {before:g} s")
    if duration is not None and time > duration:
        note = f"it is at {time:g} s; the shot lasts {duration:g} s"
        return _Fault(
            "a setpoint comes after its shot", note, f"give the shot a duration of {time:g} s or more"
        )
    return None
