"""CasADi functions over all stages in one call, on arrays of NumPy, without a copy."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import Array


class Mapped:
    """A function of one stage, evaluated at all stages.

    Its inputs and outputs are columns or matrices; they are kept as arrays whose first axis is the stage,
    matrices by column after that. Whoever calls writes into ``inputs`` and reads ``outputs``.
    """

    def __init__(self, function: Any, stages: int) -> None:
        """Take memory for it; function : a dense ``casadi.Function`` of one stage."""
        self._function = function.map(stages)
        self._buffer, self._call = self._function.buffer()
        self.inputs = [np.zeros((stages, function.numel_in(i))) for i in range(function.n_in())]
        self.outputs = [np.zeros((stages, function.numel_out(i))) for i in range(function.n_out())]
        for i, array in enumerate(self.inputs):
            self._buffer.set_arg(i, memoryview(array.data))
        for i, array in enumerate(self.outputs):
            self._buffer.set_res(i, memoryview(array.data))

    def __call__(self, *values: Array) -> list[Array]:
        """Evaluate at values, one array an input; what is returned is written over by the next call."""
        for array, value in zip(self.inputs, values, strict=True):
            array[:] = value
        self._call()
        return self.outputs


def dense(name: str, inputs: list[Any], outputs: list[Any]) -> Any:
    """Return a function whose outputs have no structural zeros."""
    return ca.Function(name, inputs, [ca.densify(out) for out in outputs], {"cse": True})
