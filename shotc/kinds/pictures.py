"""The pictures of a display in the language: shapes, letters, drawings, models."""

from functools import partial
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, GetCoreSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from shotc.ir.effects import Way
from shotc.ir.show import Easing
from shotc.kinds.effects import MOST_EFFECTS, FrameEffectSpec
from shotc.spec.colors import LightColor
from shotc.spec.fields import (
    Angle,
    Duration,
    Name,
    NonNegativeDuration,
    Position,
    PositiveLength,
    RelativePath,
    Size3,
)
from shotc.spec.fieldtypes import FieldType, Integer, one_line
from shotc.spec.model import Model, OneOf
from shotc.spec.music import MomentSpec
from shotc.spec.pydantic_faults import fault, read_each
from shotc.spec.quantities import Quantity
from shotc.spec.shorthand import QuantityModel
from shotc.units import SMALLEST, describe

MOST_PICTURES = 500

Layers = Annotated[int, Integer("Layers", 1, 4)]

Letters = Annotated[str, one_line("LineOfText", 100, "SHOTC")]


class SphereSpec(Model):
    """A ball."""

    center: Position = Field(description="middle of the ball")
    radius: PositiveLength = Field(description="radius")


class CubeSpec(Model):
    """A cube."""

    center: Position = Field(description="middle of the cube")
    size: PositiveLength = Field(description="length of an edge")
    heading: Angle = Field(default=0.0, description="compass bearing to which it is turned")


class TorusSpec(Model):
    """A ring."""

    center: Position = Field(description="middle of the ring")
    radius: PositiveLength = Field(description="from its middle to the middle of the tube")
    tube: PositiveLength = Field(description="radius of the tube")
    heading: Angle = Field(default=0.0, description="compass bearing to which its axis leans")
    tilt: Angle = Field(default=0.0, description="how far it leans: 0 lies flat, 90 deg stands upright")


class TextSpec(Model):
    """An upright text."""

    text: Letters = Field(description="what it says, one line")
    center: Position = Field(description="middle of the text")
    height: PositiveLength = Field(description="height of its capitals")
    heading: Angle = Field(default=0.0, description="direction in which a reader looks, compass bearing")
    font: RelativePath | None = Field(
        default=None, description="a font file (.ttf, .otf), or the name of a font of the system"
    )


class DrawingSpec(Model):
    """An upright drawing."""

    file: RelativePath = Field(description="an SVG file")
    center: Position = Field(description="middle of the drawing")
    height: PositiveLength = Field(description="height of the whole drawing")
    heading: Angle = Field(default=0.0, description="direction in which one looks at it, compass bearing")


class FilesSpec(Model):
    """Meshes or point clouds, one file a frame."""

    files: RelativePath = Field(description="PLY, OBJ, STL or GLB: one file, or a pattern such as walk/*.ply")
    period: Duration | None = Field(default=None, description="time from frame to frame, of several")
    center: Position | None = Field(
        default=None, description="place of the middle of the first frame; unchanged by default"
    )
    height: PositiveLength | None = Field(
        default=None, description="height to which the first frame is scaled, whatever the units of the file"
    )
    units: Literal["m", "cm", "mm", "ft", "in"] | None = Field(
        default=None, description="length of one unit of the files; GLB files are in metres"
    )
    up: Literal["x", "y", "z"] | None = Field(
        default=None, description="axis of the files that points up; y of OBJ and GLB, z of others by default"
    )
    heading: Angle = Field(default=0.0, description="compass bearing to which all are turned")


class WaveSpec(QuantityModel):
    """Departures of drones one after another, as a wave through a picture."""

    SHORT: ClassVar = ("time", Quantity("Duration", "duration", SMALLEST["duration"]))

    time: Duration = Field(description="from when the first sets out to when the last does")
    along: Way = Field(
        default="right",
        description="where it goes: an axis, right or left as the audience sees it, out from a middle or in, "
        "or by the drones' numbers (index)",
    )
    by: Literal["goal", "start"] = Field(
        default="goal", description="places that it goes through: those of this picture, or those before it"
    )
    center: Position | None = Field(
        default=None, description="from where `out` and `in` count; the picture's middle by default"
    )


class FlightSpec(Model):
    """The flight of a fleet by another tool, instead of pictures."""

    flight: RelativePath = Field(
        description="zipped CSV (.zip) or a show of Skybrush (.skyc); every drone keeps its track and light"
    )


class TransitionSpec(QuantityModel):
    """The move of a fleet to a picture from the one before, or from its pads."""

    SHORT: ClassVar = ("duration", Quantity("Duration", "duration", SMALLEST["duration"]))

    duration: Duration | None = Field(
        default=None, description="how long it takes; as fast as the pace allows by default"
    )
    path: Literal["auto", "straight", "arc"] = Field(
        default="auto",
        description="straight lines, or arcs on which pictures may be as dense as the separation allows; "
        "straight where that is proved by default",
    )
    easing: Easing = Field(
        default="ease-in-out",
        description="how the speed runs: slow at both ends and as fast as can be, as even as can be "
        "(linear), slow at its beginning (ease-in) or at its end (ease-out)",
    )
    wave: WaveSpec | None = Field(
        default=None,
        description="drones set out one after another, on straight lines; all at once by default",
    )


class PictureSpec(Model):
    """One picture of a display."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (
        OneOf((("sphere",), ("cube",), ("torus",), ("text",), ("svg",), ("model",))),
    )

    sphere: SphereSpec | None = Field(default=None, description="a ball")
    cube: CubeSpec | None = Field(default=None, description="a cube")
    torus: TorusSpec | None = Field(default=None, description="a ring")
    text: TextSpec | None = Field(default=None, description="a text")
    svg: DrawingSpec | None = Field(default=None, description="a drawing")
    model: FilesSpec | None = Field(default=None, description="meshes or point clouds, one or many")
    fill: Literal["volume", "surface", "outline"] | None = Field(
        default=None,
        description="where the drones stand: all of its inside, its surface, or edges of it; its inside by "
        "default, of a text the edges where they read better",
    )
    layers: Layers = Field(
        default=1, description="layers in depth of a text or a drawing: 2 look 1.4 times as dense, 4 twice"
    )
    color: LightColor | None = Field(
        default=None, description="colour of all lights; the file's, or white by default"
    )
    transition: TransitionSpec | None = Field(
        default=None, description="how drones come to it from the picture before: a time, or more of it"
    )
    at: MomentSpec | None = Field(
        default=None,
        description="when it stands, seconds, `{beat: 32}` or `{bar: 9}`; the picture before it stands until "
        "the way to it begins",
    )
    hold: NonNegativeDuration = Field(default=0.0, description="how long its last frame stands")
    name: Name | None = Field(default=None, description="name by which shots of cameras refer to it")
    size: Size3 | None = Field(
        default=None,
        description="width, depth and height of the box about it that cameras frame, the depth along its "
        "heading; where it is named, and no sphere, cube or torus, which have their own by "
        "default",
    )
    effects: tuple[FrameEffectSpec, ...] = Field(
        default=(), max_length=MOST_EFFECTS, description="effects on its lights, the last on top"
    )


class FramesType(FieldType):
    """The content of a display: a list of pictures, the files of one animation, or a recorded flight."""

    label = "Frames"

    def read(self, value: Any) -> "FilesSpec | FlightSpec | tuple[PictureSpec, ...]":
        """Return the pictures, the one animation, or the flight.

        Raise a fault for anything else, for no picture and for too many.
        """
        if isinstance(value, dict):
            return (FlightSpec if "flight" in value else FilesSpec).model_validate(value)
        if not isinstance(value, list):
            help_ = "write a list of pictures, the files of an animation, or `flight` and its file"
            raise fault("wrong-type", f"expected pictures, got {describe(value)}", help_)
        if not value:
            raise fault("empty-display", "the display shows no picture", "give one picture or more")
        if len(value) > MOST_PICTURES:
            message = f"the display shows {len(value)} pictures; at most {MOST_PICTURES} are"
            raise fault("wrong-length", message, "cut it into several displays")
        return tuple(read_each(((i,), partial(_picture, item)) for i, item in enumerate(value)))

    def schema(self) -> JsonSchemaValue:
        """Return an empty schema; pydantic makes that of all forms."""
        return {}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        listed = core_schema.list_schema(
            handler.generate_schema(PictureSpec), min_length=1, max_length=MOST_PICTURES
        )
        alone = [handler.generate_schema(FilesSpec), handler.generate_schema(FlightSpec)]
        both = core_schema.union_schema([*alone, listed])
        return core_schema.no_info_wrap_validator_function(lambda value, _: self.read(value), both)

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: Any) -> JsonSchemaValue:
        schema: JsonSchemaValue = handler(core)
        return schema


def _picture(value: Any) -> PictureSpec:
    return PictureSpec.model_validate(value)


Frames = Annotated[FilesSpec | FlightSpec | tuple[PictureSpec, ...], FramesType()]
