"""The command line: global flags, the commands, and the exit status of every way to end."""

import errno
import os
import sys
import traceback
from collections.abc import Sequence
from contextlib import redirect_stdout, suppress
from importlib import import_module
from platform import platform, python_version
from typing import Annotated, NamedTuple

import typer

from shotc import __version__
from shotc.cli import console
from shotc.cli.console import Color
from shotc.diag.model import Diagnostic
from shotc.plugins import is_optional, not_installed


class _Command(NamedTuple):
    """The module of a command, and its heading in the help."""

    place: str
    panel: str


_PLAN, _LEARN = "From mission to flight", "Write missions"
COMMANDS = {
    "new": _Command("shotc.cli.new:new", _LEARN),
    "import": _Command("shotc.cli.import_:import_", _LEARN),
    "check": _Command("shotc.cli.check:check", _LEARN),
    "explain": _Command("shotc.cli.explain:explain", _LEARN),
    "list": _Command("shotc.cli.inventory:show", _LEARN),
    "schema": _Command("shotc.cli.schema:schema", _LEARN),
    "identify": _Command("shotc.cli.identify:identify", _LEARN),
    "plan": _Command("shotc.cli.plan:plan", _PLAN),
    "verify": _Command("shotc.cli.verify:verify", _PLAN),
    "emit": _Command("shotc.cli.emit:emit", _PLAN),
    "simulate": _Command("shotc.cli.simulate:simulate", _PLAN),
    "stream": _Command("shotc.cli.stream:stream", _PLAN),
    "view": _Command("shotc.cli.view:view", _PLAN),
    "compare": _Command("shotc.cli.compare:compare", _PLAN),
    "diff": _Command("shotc.cli.diff:diff", _PLAN),
}
_HELP = """Compile a YAML mission into verified, flyable camera motion.

In three steps:

1. `shotc new landmark -o tower.yaml` starts a mission from a template
2. `shotc check tower.yaml` says what is wrong with it, and where
3. `shotc plan tower.yaml` plans it, proves the plan and writes what flies
"""
_EPILOG = "Exit status: 0 clean, 1 mission rejected, 2 usage, 70 a bug of ours, 130 interrupted."
_BROKEN_PIPE = 128 + 13
"""The exit status that a shell gives a command that a closed pipe ended."""


def run(arguments: Sequence[str]) -> int:
    """Run one command line and return its exit status. It raises no exception."""
    _open_streams()
    try:
        code = _invoke(arguments)
        sys.stdout.flush()
        return code
    except SystemExit as end:
        # The library turns a closed pipe into its own exit.
        if isinstance(end.__context__, BrokenPipeError):
            return _pipe_closed()
        return end.code if isinstance(end.code, int) else console.EXIT_BUG
    except (KeyboardInterrupt, typer.Abort):
        return _interrupted()
    except OSError as error:
        return _no_output(error)
    except ModuleNotFoundError as missing:
        return _not_installed(missing)
    except Exception as bug:  # noqa: BLE001  any other exception is a bug of shotc
        return _bug(bug)


def application(names: Sequence[str] = tuple(COMMANDS)) -> typer.Typer:
    """Return the application with only these commands, so that it does not load the modules of others."""
    app = typer.Typer(
        name="shotc",
        help=_HELP,
        epilog=_EPILOG,
        add_completion=len(names) == len(COMMANDS),
        rich_markup_mode="markdown",
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_global_flags)
    for name in names:
        command = COMMANDS[name]
        module, _, attribute = command.place.partition(":")
        app.command(name, rich_help_panel=command.panel)(getattr(import_module(module), attribute))
    return app


def _print_version(requested: bool) -> None:
    if requested:
        console.out(f"shotc {__version__}")
        raise typer.Exit


Version = Annotated[
    bool,
    typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit."),
]
ColorOption = Annotated[Color, typer.Option("--color", help="When to colour; NO_COLOR is respected.")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print errors and results only.")]


def _global_flags(
    ctx: typer.Context, version: Version = False, color: ColorOption = Color.AUTO, quiet: Quiet = False
) -> None:
    console.configure(color, quiet=quiet)
    if ctx.invoked_subcommand is None:
        with redirect_stdout(sys.stderr):  # without a command, the help is a message, not a result
            ctx.get_help()
        raise typer.Exit(console.EXIT_USAGE)


def _invoke(arguments: Sequence[str]) -> int:
    flags, words = _split_flags(arguments)
    try:
        code = application(_needed(words))(flags + words, prog_name="shotc", standalone_mode=False)
    except typer.TyperException as error:
        return _usage(error)
    return _interrupted() if code == console.EXIT_INTERRUPTED else int(code or 0)


def _needed(words: Sequence[str]) -> Sequence[str]:
    """Return the commands that a command line needs: the named one, or all to list or complete them."""
    if not words or "_SHOTC_COMPLETE" in os.environ:
        return tuple(COMMANDS)
    if words[0] == "--version":
        return ("schema",)
    return (words[0],) if words[0] in COMMANDS else tuple(COMMANDS)


def _split_flags(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Separate the global flags, which may be anywhere before ``--``, from the other words."""
    flags: list[str] = []
    others: list[str] = []
    words = iter(arguments)
    for word in words:
        if word == "--":
            others += [word, *words]
        elif word in ("-q", "--quiet") or word.startswith("--color="):
            flags.append(word)
        elif word == "--color":
            flags += [word, *([value] if (value := next(words, None)) is not None else [])]
        else:
            others.append(word)
    return flags, others


def _usage(error: typer.TyperException) -> int:
    context = getattr(error, "ctx", None)
    path = context.command_path if context is not None else "shotc"
    console.complain(f"error: {error.format_message()}\ntry `{path} --help`")
    return console.EXIT_USAGE


def _interrupted() -> int:
    console.complain("interrupted")
    return console.EXIT_INTERRUPTED


def _pipe_closed() -> int:
    """Redirect standard output to the null device, so that the interpreter's flush at exit does not fail."""
    with suppress(OSError, ValueError):  # a stream without a file descriptor has nothing to flush
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return _BROKEN_PIPE


def _not_installed(missing: ModuleNotFoundError) -> int:
    """Report a command that needs more than the base install."""
    if not is_optional(missing):
        return _bug(missing)
    console.report([not_installed("P004", "this command", [str(missing.name)])], {})
    return console.EXIT_REJECTED


def _no_output(error: OSError) -> int:
    """End a command whose output cannot be written. Any other OSError is a bug."""
    if isinstance(error, BrokenPipeError):
        return _pipe_closed()
    if error.errno not in (errno.ENOSPC, errno.EIO, errno.EBADF):
        return _bug(error)
    _pipe_closed()
    console.complain(f"standard output cannot be written: {error.strerror}")
    return console.EXIT_REJECTED


def _bug(bug: BaseException) -> int:
    """Report an internal error as a diagnostic. The traceback is only shown on request."""
    frames = traceback.extract_tb(bug.__traceback__)
    where = f"{frames[-1].name} at line {frames[-1].lineno} of {frames[-1].filename}" if frames else "unknown"
    diagnostic = Diagnostic(
        "X001",
        "shotc failed; this is our bug, not yours",
        notes=(
            f"{type(bug).__name__}: {bug}",
            f"in {where}",
            f"shotc {__version__}, Python {python_version()}, {platform()}",
        ),
        help="run again with SHOTC_DEBUG=1 and report what it prints, together with the mission",
    )
    console.report([diagnostic], {})
    if os.environ.get("SHOTC_DEBUG") == "1":
        traceback.print_exception(bug)
    return console.EXIT_BUG


def _open_streams() -> None:
    """Open the null device for a process that was started without output streams."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w")  # noqa: PTH123, SIM115  lives as long as the process
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: PTH123, SIM115
