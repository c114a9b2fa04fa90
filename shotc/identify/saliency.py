"""Guesses the subject of a picture: the interface of saliency models, and a model without training data.

Gebhardt and Hilliges found that no saliency model they tried predicts the intended target better than the
middle of the picture does (Sec. 5). A result is therefore a guess that the author has to check.
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

WIDTH_PX = 80
"""Columns of the examined picture; smaller details are no subject."""
BLUR_PX = 2.0
SALIENT_RATIO = 2.0
"""Saliency over its mean, above which a pixel is salient."""


class Saliency(Protocol):
    """A model that guesses the position of the subject in a picture.

    name : for `--saliency`
    summary : one line for listings
    api : version of this interface
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    api: ClassVar[int]

    def box(self, picture: Array) -> ScreenBox | None:
        """Return the box around the subject, or None if there is none.

        picture : shape (rows, columns, 3), the upper left pixel first; red, green and blue from 0 to 1
        """


class Guesser(NamedTuple):
    """A saliency model and its package."""

    model: Saliency
    package: str

    def box(self, picture: Array) -> ScreenBox | Diagnostic | None:
        """Return the box that the model gives, None if it gives none, or a diagnostic if the box is unusable.

        picture : shape (rows, columns, 3), as in ``Saliency.box``
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
    """The spectral residual: what differs from the rest of a picture, by its spectrum.

    X. Hou, L. Zhang, Saliency detection: a spectral residual approach (2007), Eq. 7 to 10.
    """

    name: ClassVar[str] = "spectral-residual"
    summary: ClassVar[str] = "what is unlike the rest of the picture, by its spectrum"
    api: ClassVar[int] = 1

    def box(self, picture: Array) -> ScreenBox | None:
        """Return the box around the connected salient region with the largest weight.

        picture : shape (rows, columns, 3)
        """
        salient = _salient(_smaller(picture.mean(axis=2)))
        if not np.isfinite(salient).all() or salient.max() <= 0.0:
            return None
        parts, count = label(salient > SALIENT_RATIO * salient.mean())
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
    """Return a picture averaged over square blocks, with at least WIDTH_PX columns; shape (rows, columns)."""
    by = max(1, grey.shape[1] // WIDTH_PX)
    rows, columns = (length // by for length in grey.shape)
    return np.asarray(grey[: rows * by, : columns * by].reshape(rows, by, columns, by).mean(axis=(1, 3)))


def _salient(grey: Array) -> Array:
    """Return the saliency of each pixel, shape (rows, columns), at least 0."""
    spectrum = np.fft.fft2(grey)
    amplitude = np.log(np.abs(spectrum) + 1e-9)
    residual = amplitude - uniform_filter(amplitude, 3, mode="wrap")
    back = np.fft.ifft2(np.exp(residual + 1j * np.angle(spectrum)))
    return np.asarray(gaussian_filter(np.abs(back) ** 2, BLUR_PX, mode="nearest"))


SALIENCY = SpectralResidual()
