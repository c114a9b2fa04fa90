"""Display: a fleet draws pictures in the air. Checked, but not planned yet."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.mission import Deferred
from shotc.kinds.base import Expansion, Kind, Scene
from shotc.spec.fields import Duration, Name, Position, RelativePath
from shotc.spec.model import Model, OneOf
from shotc.spec.quantities import Quantity
from shotc.spec.shot import ShotBase
from shotc.spec.words import nearest


class FramesSpec(Model):
    """The animation's frames."""

    files: RelativePath = Field(description="point clouds or meshes, a pattern such as walk/*.ply")
    period: Duration = Field(description="time from frame to frame")


class DisplayShot(ShotBase):
    """The parameters of a display; a fleet takes the place of the drone."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("fleet",), ("drone",)), required=False),)

    kind: Literal["display"] = Field(description="what sort of shot it is")
    drone: Name = Field(default="auto", description="not for a display: it has a fleet")
    fleet: Name = Field(description="name of the fleet that draws")
    frames: FramesSpec = Field(description="what it draws")
    viewpoint: Position | None = Field(default=None, description="where the audience is")
    viewpoint_weight: Annotated[float, Quantity("ViewpointWeight", "ratio", 0.0, 1.0)] = Field(
        default=0.0, description="how much the view from there counts"
    )


def expand(shot: DisplayShot, scene: Scene) -> Expansion:
    """Check the fleet's name; planning waits for a later version."""
    later = Deferred("a shot of kind `display`", (*scene.path, "kind"))
    if shot.fleet in scene.fleets:
        return Expansion.of([later])
    help_ = nearest(shot.fleet, dict.fromkeys(scene.fleets)) if scene.fleets else "define it under `fleets`"
    label = scene.origins.value((*scene.path, "fleet"))
    return Expansion.of([Diagnostic("N003", f"unknown fleet `{shot.fleet}`", (label,), help=help_), later])


KIND = Kind("display", "let a fleet draw pictures in the air", DisplayShot, expand, planned=False)
