"""U: quantities and their units. See shotc.diag.registry."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import LOOK, slip

CODES: tuple[CodeInfo, ...] = (
    slip(
        "U001",
        "unknown-unit",
        "a unit is not known",
        "Units come from a closed table, so that nothing is guessed: m, mm, cm, km, ft; s, ms, min, h; m/s,"
        " km/h, kn, mph, ft/s; m/s^2; m/s^3; deg, rad, and both per s and s^2; %; Hz. Spelling counts: "
        "`Hz`, not `hz`. `g` is not among them, since it is a gram to some and an acceleration to others.",
        LOOK,
        ("wind: 3 m/s", "wind: 3 m/sec"),
    ),
    slip(
        "U002",
        "wrong-dimension",
        "the unit belongs to another kind of quantity",
        "The unit is known, but measures something else: a speed cannot be given in seconds. Both kinds of "
        "quantity are named.",
        LOOK,
        ("wind: 3 m/s", "wind: 3 s"),
    ),
    slip(
        "U003",
        "bare-angle",
        "an angle has no unit",
        "A bare number means SI units everywhere, but for angles people expect degrees where SI has "
        "radians, and both look alike. Angles and their rates are therefore always written with a unit: `45"
        " deg`, `0.8 rad`, `60 deg/s`. This holds for 0 as well.",
        LOOK,
        ("hfov: 70 deg", "hfov: 70"),
    ),
    slip(
        "U004",
        "missing-unit",
        "a number in quotes has no unit",
        "A quantity is a bare number in SI units, or text with a unit. A number in quotes is text and has "
        "none; it often comes from a template or another tool. Remove the quotes, or add the unit inside "
        "them.",
        LOOK,
        ("wind: 3 m/s", 'wind: "3"'),
    ),
    slip(
        "U005",
        "not-a-quantity",
        "a value is no number with a unit",
        "A quantity is one number, and a unit after it. Sums, ranges in words, thousands separators and "
        "decimal commas are not read; nothing is evaluated.",
        LOOK,
        ("wind: 3 m/s", "wind: 3 to 5 m/s"),
    ),
    slip(
        "U006",
        "absurd-value",
        "a quantity is not finite or far too large",
        "Infinity, not-a-number and magnitudes that no camera drone meets (beyond 100 km, 1000 m/s, a day "
        "in the air) are slips. Without this check they would appear later as strange failures of the "
        "solver. The help names the largest magnitude.",
        LOOK,
        ("wind: 3 m/s", "wind: 1e300"),
    ),
)
