"""The film terms for the size of a target in the picture: its projected height over the frame's height.

The ladder of names is the one of film handbooks (Bowen and Thompson, Grammar of the Shot; Katz, Film
Directing Shot by Shot), which define sizes by where the frame cuts a standing person: below the feet (full),
above the knees (medium-full), at the waist (medium), at the shoulders (close-up), inside the face (extreme
close-up). Drillis and Contini's table (Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1)
gives these heights as shares of the body's height: knee 0.285, hip 0.530, shoulder 0.818, chin 0.870,
eye 0.936. With 8 % of the frame above the head, a cut at c gives 0.92 / (1 - c), rounded here. The wide sizes
and the extreme one are our choice. Above 1 the target is cropped on purpose; a mission writes this only by
name.
"""

from __future__ import annotations

SIZES: dict[str, float] = {
    "establishing": 0.1,  # the location, with the target as a part of it
    "long": 0.4,  # the target in its surroundings
    "full": 0.9,  # the whole target, with a little room
    "medium-full": 1.4,  # c = 0.34
    "medium": 2.2,  # c = 0.58
    "close-up": 5.0,  # c = 0.82
    "extreme-close-up": 10.0,  # a tenth of the target: of a person, forehead to chin
}
