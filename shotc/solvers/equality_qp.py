"""A quadratic programme whose only constraints are equalities: one sparse linear system.

The energy of a spline with short and long pieces can outweigh its anchors by 15 orders of magnitude. The
solution of such a system as it stands leaves the anchors by centimetres. Therefore it is scaled, unknowns by
the Hessian's diagonal and equalities by their largest entry then, and refined once.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from shotc.geom.bernstein import Array


def minimise_under_equalities(hessian: Any, slope: Array, rows: Any, values: Array) -> Array | None:
    """Return the x, shape (N, K), with the least x.hessian.x / 2 - slope.x under rows @ x = values.

    hessian : sparse (N, N); slope : (N, K); rows : sparse (M, N); values : (M, K)
    The result is None if the optimum is not unique.
    """
    from scipy.sparse import bmat, diags
    from scipy.sparse.linalg import splu

    diagonal = hessian.diagonal()
    unknowns = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    largest = abs(rows @ diags(unknowns)).max(axis=1).toarray().ravel()
    scale = np.concatenate([unknowns, 1.0 / np.where(largest > 0.0, largest, 1.0)])
    system = (diags(scale) @ bmat([[hessian, rows.T], [rows, None]]) @ diags(scale)).tocsc()
    right = scale[:, None] * np.concatenate([slope, values])
    try:
        factors = splu(system)
    except RuntimeError:  # singular: the cost and the equalities leave a direction free
        return None
    solved = factors.solve(right)
    solved += factors.solve(right - system @ solved)
    found = np.asarray(unknowns[:, None] * solved[: len(slope)])
    return found if np.isfinite(found).all() else None
