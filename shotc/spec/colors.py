"""Colours of lights: CSS names, or three or six hexadecimal digits; stored as (red, green, blue)."""

import re
from typing import Annotated, Any

from pydantic.json_schema import JsonSchemaValue

from shotc.ir.effects import Color
from shotc.spec.fieldtypes import FieldType, NamedOr
from shotc.spec.pydantic_faults import fault
from shotc.units import clip, describe

COLORS: dict[str, Color] = {
    "white": (255, 255, 255),
    "silver": (192, 192, 192),
    "gray": (128, 128, 128),
    "red": (255, 0, 0),
    "crimson": (220, 20, 60),
    "tomato": (255, 99, 71),
    "coral": (255, 127, 80),
    "orange": (255, 165, 0),
    "gold": (255, 215, 0),
    "yellow": (255, 255, 0),
    "ivory": (255, 255, 240),
    "lime": (0, 255, 0),
    "green": (0, 128, 0),
    "olive": (128, 128, 0),
    "teal": (0, 128, 128),
    "turquoise": (64, 224, 208),
    "aqua": (0, 255, 255),
    "cyan": (0, 255, 255),
    "skyblue": (135, 206, 235),
    "blue": (0, 0, 255),
    "royalblue": (65, 105, 225),
    "navy": (0, 0, 128),
    "indigo": (75, 0, 130),
    "purple": (128, 0, 128),
    "violet": (238, 130, 238),
    "magenta": (255, 0, 255),
    "fuchsia": (255, 0, 255),
    "pink": (255, 192, 203),
    "maroon": (128, 0, 0),
    "brown": (165, 42, 42),
    "black": (0, 0, 0),
}

_HINT = 'write a name such as orange, or digits in quotes such as "#f80" or "#ff8800"'
_PATTERN = r"#([0-9A-Fa-f]{3}|[0-9A-Fa-f]{6})"


class HexColorType(FieldType):
    """A colour in hexadecimal digits."""

    label = "HexColor"

    def read(self, value: Any) -> Color:
        """Return (red, green, blue), 0 to 255 each. Raise a fault unless it is a hexadecimal colour."""
        if not isinstance(value, str):
            raise fault("wrong-type", f"expected a colour, got {describe(value)}", _HINT)
        if re.fullmatch(_PATTERN, value) is None:
            raise fault("unknown-value", f"`{clip(value)}` is no colour", _HINT)
        digits = value[1:] if len(value) == 7 else "".join(2 * digit for digit in value[1:])
        red, green, blue = bytes.fromhex(digits)
        return (red, green, blue)

    def schema(self) -> JsonSchemaValue:
        """Return a string schema."""
        return {"type": "string", "pattern": f"^{_PATTERN}$", "description": _HINT}


LightColor = Annotated[Color, NamedOr("Color", COLORS, "colour", HexColorType())]
