"""A guess of what a picture is about: the seat of saliency models, and the one that needs nothing but sums.

Gebhardt and Hilliges found that no saliency model they tried knows what somebody means better than the middle
of the picture does (Sec. 5): what comes from here is a guess that its author has to look at.
"""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Protocol

import numpy as np
from scipy.ndimage import gaussian_filter, label, uniform_filter

from shotc.diag.model import Diagnostic
from shotc.diag.plugin_faults import plugin_failed
from shotc.geom.bernstein import Array
from shotc.geom.camera import ScreenBox
from shotc.plugins import OURS

WIDTH = 80
"""Columns of the picture that is looked at: what is smaller is no subject."""
BLUR_PX = 2.0
TIMES_MEAN = 2.0
"""Of the mean of the map, from which a place is salient."""


class Saliency(Protocol):
    """What guesses where in a picture its subject is.

    name : as `--saliency` says it; summary : one line for listings; api : version of this contract
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def box(self, picture: Array) -> ScreenBox | None:
        """Return the box round the subject, or None where there seems to be none.

        picture : shape (rows, columns, 3), the upper left pixel first, red, green and blue of 0 to 1
        """


class Guesser(NamedTuple):
    """A saliency model, and the package that it comes from."""

    model: Saliency
    package: str

    def box(self, picture: Array) -> ScreenBox | Diagnostic | None:
        """Return the box that the model gives, None where it gives none, or why that cannot be used.

        picture : as of ``Saliency.box``
        """
        what = f"saliency model `{self.model.name}`"
        try:
            given = self.model.box(picture)
            box = None if given is None else ScreenBox(*(float(c) for c in given))
        except Exception as fault:
            if self.package == OURS:
                raise
            return plugin_failed(what, self.package, fault)
        if box is None or _is_box(box):
            return box
        return plugin_failed(what, self.package, f"it gives {tuple(box)}, which is no box on the screen")


def _is_box(box: ScreenBox) -> bool:
    return bool(-1.0 <= box.u_min < box.u_max <= 1.0 and -1.0 <= box.v_min < box.v_max <= 1.0)


class SpectralResidual:
    """What is unlike the rest of a picture, by its spectrum.

    X. Hou, L. Zhang, Saliency detection: a spectral residual approach (2007), Eq. 7 to 10.
    """

    name: ClassVar[str] = "spectral-residual"
    summary: ClassVar[str] = "what is unlike the rest of the picture, by its spectrum"
    api: ClassVar[int] = 1

    def box(self, picture: Array) -> ScreenBox | None:
        """Return the box round the heaviest part of what is salient; picture : shape (rows, columns, 3)."""
        salient = _salient(_smaller(picture.mean(axis=2)))
        if not np.isfinite(salient).all() or salient.max() <= 0.0:
            return None
        parts, count = label(salient > TIMES_MEAN * salient.mean())
        if not count:
            return None
        weight = np.bincount(parts.ravel(), salient.ravel())
        rows, columns = np.nonzero(parts == 1 + int(weight[1:].argmax()))
        height, width = salient.shape
        return ScreenBox(
            2.0 * columns.min() / width - 1.0,
            2.0 * (columns.max() + 1) / width - 1.0,
            1.0 - 2.0 * (rows.max() + 1) / height,
            1.0 - 2.0 * rows.min() / height,
        )


def _smaller(grey: Array) -> Array:
    """Return a picture of WIDTH columns or more, of means of squares of pixels; shape (rows, columns)."""
    by = max(1, grey.shape[1] // WIDTH)
    rows, columns = (length // by for length in grey.shape)
    return np.asarray(grey[: rows * by, : columns * by].reshape(rows, by, columns, by).mean(axis=(1, 3)))


def _salient(grey: Array) -> Array:
    """Return how salient each pixel is, shape (rows, columns), at least 0."""
    spectrum = np.fft.fft2(grey)
    amplitude = np.log(np.abs(spectrum) + 1e-9)
    residual = amplitude - uniform_filter(amplitude, 3, mode="wrap")
    back = np.fft.ifft2(np.exp(residual + 1j * np.angle(spectrum)))
    return np.asarray(gaussian_filter(np.abs(back) ** 2, BLUR_PX, mode="nearest"))


SALIENCY = SpectralResidual()
