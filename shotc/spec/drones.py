"""Drones in the language: a preset and its overrides."""

from math import degrees, radians
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import InitErrorDetails

from shotc.geom.focal import FULL_FRAME_M, field_of_view
from shotc.ir.drone import LensRange
from shotc.spec.exposure import ApertureType, Millimetres, ShutterType
from shotc.spec.fields import (
    Acceleration,
    AngleRange,
    AngularAcceleration,
    AngularRate,
    Aspect,
    Duration,
    FieldOfView,
    Jerk,
    LengthRange,
    PitchRange,
    PositiveLength,
    PositiveShare,
    Priority,
    Speed,
    Stand,
)
from shotc.spec.fieldtypes import FieldType, Hinted, Integer, NamedOr
from shotc.spec.heights import STANDING
from shotc.spec.model import Model, OneOf, section
from shotc.spec.presets import DEFAULT_MODEL, PRESETS, RESERVE_SHARE, ZOOM_RATE_RAD_S
from shotc.spec.pydantic_faults import fault, fault_at, together
from shotc.spec.quantities import Percentage, Quantity, Tuple, WattHours
from shotc.units import SMALLEST

ModelName = Annotated[
    str, NamedOr("DroneModel", {name: name for name in PRESETS}, "drone model", all_by="shotc list drones")
]

# A drone with a lower tilt or thrust limit than these can hardly move.
Tilt = Annotated[float, Quantity("Tilt", "angle", radians(1.0), radians(80.0), noun="tilt")]
ThrustToWeight = Annotated[float, Quantity("ThrustToWeight", "ratio", 1.02, 20.0, noun="ratio")]

Mass = Annotated[float, Quantity("Mass", "mass", SMALLEST["mass"])]
Circle = Annotated[float, Millimetres("Circle", "length", 1e-6, 1e-3, noun="circle of confusion")]
Energy = Annotated[float, WattHours("Energy", "energy", 360.0)]
Reserve = Annotated[float, Percentage("Reserve", "ratio", 0.0, 0.9, noun="reserve")]
SAME_ASPECT = 0.01  # relative tolerance of an aspect ratio that is given twice


class SensorType(FieldType):
    """The sensor's width, or ``[width, height]``; stored as (width, height or None)."""

    label = "Sensor"
    _side = Hinted(
        Quantity("PositiveLength", "length", SMALLEST["length"]),
        r".*(in|inch|inches|[\"'”])(\W.*)?",
        "give the sensor's width, such as `13.2 mm`; a size in inches is the name of a class of sensors",
    )
    _both = Tuple("SensorSize", (_side, _side), "[width, height]")

    def read(self, value: Any) -> tuple[float, float | None]:
        """Return (width, height or None), metres."""
        if isinstance(value, list):
            width, height = self._both.read(value)
            return (width, height)
        return (self._side.read(value), None)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [self._side.reference(), self._both.schema()]}


class LimitsSpec(Model):
    """The limits of a drone; omitted ones are those of the preset."""

    speed: Speed | None = Field(default=None, description="horizontal speed")
    climb: Speed | None = Field(default=None, description="vertical speed upwards")
    descent: Speed | None = Field(default=None, description="vertical speed downwards, positive")
    acceleration: Acceleration | None = Field(default=None, description="acceleration in space")
    jerk: Jerk | None = Field(default=None, description="jerk in space")
    yaw_rate: AngularRate | None = Field(default=None, description="turning rate of the body")
    yaw_acceleration: AngularAcceleration | None = Field(default=None, description="its rate of change")
    tilt: Tilt | None = Field(
        default=None, description="angle of the rotors' thrust from the vertical; not limited by default"
    )
    thrust_to_weight: ThrustToWeight | None = Field(
        default=None, description="thrust over weight, above 1; not limited by default"
    )


class CameraSpec(Model):
    """The camera: its field of view, or sensor and focal length."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("hfov",), ("sensor", "focal_length")), required=False),)

    hfov: FieldOfView | None = Field(default=None, description="horizontal field of view")
    sensor: Annotated[tuple[float, float | None], SensorType()] | None = Field(
        default=None,
        description="width of the area that takes the picture, such as 13.2 mm, or [width, height]; "
        "with focal_length it gives the field of view",
    )
    focal_length: PositiveLength | None = Field(default=None, description="focal length of the lens")
    zoom: LengthRange | None = Field(
        default=None,
        description="[shortest, longest] focal length of a zoom lens, such as [24 mm, 70 mm]: on the "
        "`sensor`, or on a frame 36 mm wide by default",
    )
    zoom_rate: AngularRate | None = Field(
        default=None, description="how fast the field of view changes at most; 10 deg/s by default"
    )
    aperture: Annotated[float, ApertureType()] | None = Field(
        default=None, description="f-number of the lens, such as f/2.8: gives the depth of field"
    )
    circle_of_confusion: Circle | None = Field(
        default=None,
        description="diameter on the sensor up to which a point counts as sharp; 0.03 mm of a sensor 36 mm "
        "wide, and as much less as the sensor is narrower by default",
    )
    shutter: Annotated[float, ShutterType()] | None = Field(
        default=None, description="time of exposure, such as 1/50 s: gives the motion blur"
    )
    pixels: Annotated[int, Integer("Pixels", 100, 20_000)] | None = Field(
        default=None, description="width of the picture that motion blur is counted in; 3840 by default"
    )
    aspect: Aspect | None = Field(default=None, description='frame width over height, such as "16:9"')

    @property
    def field_of_view(self) -> float | None:
        """Horizontal field of view, rad; None for that of the preset."""
        if self.sensor is not None and self.focal_length is not None:
            return field_of_view(self.focal_length, self.sensor[0])
        return self.hfov if self.hfov is not None or self.lens is None else self.lens.widest

    @property
    def lens(self) -> LensRange | None:
        """The zoom lens; None if there is none in the mission."""
        if self.zoom is None:
            return None
        width = FULL_FRAME_M if self.sensor is None else self.sensor[0]
        widest, longest = (field_of_view(focal, width) for focal in self.zoom)
        return LensRange(
            longest, widest, ZOOM_RATE_RAD_S if self.zoom_rate is None else self.zoom_rate, width
        )

    @property
    def aspect_ratio(self) -> float | None:
        """Frame width over height; None for that of the preset."""
        if self.aspect is not None or self.sensor is None or self.sensor[1] is None:
            return self.aspect
        return self.sensor[0] / self.sensor[1]

    @model_validator(mode="after")
    def _possible(self) -> Self:
        hfov, aspect = self.field_of_view, self.aspect_ratio
        if hfov is not None and not 1.0 <= degrees(hfov) <= 170.0:
            raise fault_at(
                ("focal_length",),
                "impossible-camera",
                f"sensor and focal length give a field of view of {degrees(hfov):.4g} deg",
                "the field of view lies between 1 deg and 170 deg; check both units",
            )
        if aspect is not None and not 0.2 <= aspect <= 5.0:
            raise fault_at(
                ("sensor",),
                "impossible-camera",
                f"the sensor is {aspect:.4g} times as wide as high",
                "write [width, height]; frames lie between 1:5 and 5:1",
            )
        self._agree()
        self._zooms()
        self._exposes()
        return self

    def _zooms(self) -> None:
        """Raise a fault if the field of view is outside the zoom range, or a zoom rate has no zoom."""
        lens, hfov = self.lens, self.field_of_view
        if lens is None and self.zoom_rate is not None:
            raise fault_at(
                ("zoom_rate",),
                "conflicting-fields",
                "`zoom_rate` is said of a lens that does not zoom",
                "write `zoom: [24 mm, 70 mm]` beside it, or take it out",
            )
        if lens is not None and hfov is not None and not lens.shows(hfov):
            key = "hfov" if self.hfov is not None else "focal_length"
            raise fault_at(
                (key,),
                "impossible-camera",
                f"a field of view of {degrees(hfov):.4g} deg is none of the zoom's",
                f"it goes from {degrees(lens.longest):.4g} to {degrees(lens.widest):.4g} deg",
            )

    def _exposes(self) -> None:
        """Raise a fault if a number of the exposure lacks another one that it needs."""
        for key, value, needs, example in (
            ("circle_of_confusion", self.circle_of_confusion, "aperture", "f/2.8"),
            ("pixels", self.pixels, "shutter", "1/50 s"),
        ):
            if value is not None and getattr(self, needs) is None:
                raise fault_at(
                    (key,),
                    "conflicting-fields",
                    f"`{key}` is said of a camera without `{needs}`",
                    f"write `{needs}: {example}` beside it, or take it out",
                )

    def _agree(self) -> None:
        """Raise a fault if the aspect ratio is given twice with different values."""
        if self.aspect is None or self.sensor is None or self.sensor[1] is None:
            return
        shape = self.sensor[0] / self.sensor[1]
        if abs(shape / self.aspect - 1) <= SAME_ASPECT:
            return
        clash = fault(
            "conflicting-fields",
            f"`aspect` says {self.aspect:.4g} times as wide as high, `sensor` says {shape:.4g} times",
            "remove `aspect`, or give the width of the sensor alone: `sensor: "
            f"{1000 * self.sensor[0]:.4g} mm`",
            beside="sensor",
        )
        raise together([InitErrorDetails(type=clash, loc=("aspect",), input=None)])


class GimbalSpec(Model):
    """The ranges and rates of a gimbal; omitted ones are those of the preset."""

    pitch: PitchRange | None = Field(default=None, description="[lowest, highest] against the horizon")
    yaw: AngleRange | None = Field(default=None, description="[lowest, highest] against the body")
    rate: AngularRate | None = Field(default=None, description="turning rate of each axis")
    acceleration: AngularAcceleration | None = Field(default=None, description="its rate of change")


class RotorsSpec(Model):
    """The rotors of a drone."""

    count: Annotated[int, Integer("Rotors", 3, 16)] = Field(description="how many")
    radius: PositiveLength = Field(description="radius of each, half a propeller's length")


class PowerSpec(Model):
    """The energy of a drone's battery, and the power for hovering."""

    exclusive: ClassVar[tuple[OneOf, ...]] = (OneOf((("hover",), ("efficiency",))),)

    mass: Mass = Field(description="the drone as it flies, with camera and battery")
    battery: Energy = Field(description="energy of the full battery, such as 77 Wh")
    rotors: RotorsSpec = Field(description="the rotors, which with the mass give the ideal power")
    hover: Duration | None = Field(
        default=None, description="how long a full battery hovers at sea level, as makers publish it"
    )
    efficiency: PositiveShare | None = Field(
        default=None, description="ideal power of hovering over the power that the battery gives"
    )
    reserve: Reserve = Field(
        default=RESERVE_SHARE, description="share of the battery that is left at landing"
    )


class SafetySpec(Model):
    """What a drone does on a failure."""

    link_lost: Literal["return", "hover", "land", "continue"] | None = Field(
        default=None, description="what it does when its link is lost; the machine's own by default"
    )
    return_height: PositiveLength | None = Field(
        default=None, description="height above home at which it returns, over all that stands there"
    )
    rally: tuple[Stand, ...] = Field(
        default=(), description="places where it may land instead of at home, [[x, y], ...]"
    )


class DroneSpec(Model):
    """A drone of the mission."""

    model: ModelName = Field(default=DEFAULT_MODEL, description="preset that fills in what is not given")
    home: Stand = Field(
        default=(0.0, 0.0, STANDING),
        description="where it stands before and after; on the ground where no height is written",
    )
    limits: LimitsSpec = section("what it may do")
    gimbal: GimbalSpec | None = Field(default=None, description="what its gimbal reaches")
    camera: CameraSpec = section("what its camera sees")
    radius: PositiveLength | None = Field(default=None, description="radius of the sphere round its body")
    endurance: Duration | None = Field(
        default=None, description="longest time in the air; by default, by the energy where power is known"
    )
    power: PowerSpec | None = Field(
        default=None, description="battery, mass and rotors, from which the energy of flights is proved"
    )
    safety: SafetySpec | None = Field(
        default=None, description="what it does when its link is lost, and where it may land"
    )
    priority: Priority = Field(default=1, description="drones are planned in this order, 1 first")
    body: Literal["forward", "follow-camera", "free"] | None = Field(
        default=None, description="where the body points: along the path, with the camera, or anywhere"
    )
