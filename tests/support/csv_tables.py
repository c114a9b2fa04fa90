"""Reading the CSV files that `plan` writes, as a user's script would: by the names of their columns."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array

TEXT = ("drone", "phase", "shot", "target")


@dataclass(frozen=True)
class Table:
    """The columns of one CSV file: text as lists, numbers as arrays with NaN where a cell is empty."""

    header: tuple[str, ...]
    columns: dict[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.columns[name]

    def numbers(self, *names: str) -> Array:
        """Return columns side by side, shape (rows, len(names))."""
        return np.column_stack([self.columns[name] for name in names])

    def where(self, **wanted: str) -> Table:
        """Return the rows whose text columns hold these values."""
        mask = np.ones(len(self.columns[self.header[0]]), dtype=bool)
        for name, value in wanted.items():
            mask &= self.columns[name] == value
        return self.rows(mask)

    def rows(self, mask: Any) -> Table:
        """Return the rows for which this is true."""
        return Table(self.header, {name: column[mask] for name, column in self.columns.items()})

    def every(self, count: int) -> Table:
        """Return every so manieth row, the first among them."""
        return Table(self.header, {name: column[::count] for name, column in self.columns.items()})

    def __len__(self) -> int:
        return len(self.columns[self.header[0]])


def read(data: bytes) -> Table:
    """Read one CSV file."""
    header, *rows = csv.reader(io.StringIO(data.decode("ascii")))
    cells = list(zip(*rows, strict=True)) if rows else [()] * len(header)
    columns = {
        name: np.array(column) if name in TEXT else np.array([float(c or "nan") for c in column])
        for name, column in zip(header, cells, strict=True)
    }
    return Table(tuple(header), columns)
