"""Options of commands that work in parallel, and diagnostics for failures of that."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Annotated

import typer

from shotc import plugins
from shotc.cli import console
from shotc.diag.model import Diagnostic
from shotc.parallel import Lost, NoCluster

Workers = Annotated[
    str | None,
    typer.Option(metavar="tcp://HOST:PORT", help="The scheduler of a Dask cluster that does the work."),
]


def no_cluster(workers: str | None) -> tuple[Diagnostic, ...]:
    """Return the diagnostic of a cluster that cannot be used because `distributed` is not installed."""
    if workers is None or find_spec("distributed") is not None:
        return ()
    return (plugins.not_installed("P004", "`--workers`", ["distributed"]),)


@contextmanager
def at_work() -> Iterator[None]:
    """Run the body. If no cluster answers or a process is lost, report it and exit."""
    try:
        yield
    except NoCluster as error:
        help_ = "start one with `dask scheduler`, or leave `--workers` out"
        console.report([Diagnostic("W006", f"no scheduler answers: {error}", help=help_)], {})
        raise typer.Exit(console.EXIT_REJECTED) from None
    except Lost:
        help_ = (
            "run it again, which goes on from here; where memory is short, with fewer processes: `--jobs 1`"
        )
        console.report([Diagnostic("W007", "a process was killed while it worked", help=help_)], {})
        raise typer.Exit(console.EXIT_REJECTED) from None
