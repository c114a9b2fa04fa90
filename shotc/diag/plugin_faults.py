"""Diagnostics for a plugin that raises an exception or returns a wrong value."""

from shotc.diag.model import Diagnostic, Label


def one_line(fault: BaseException) -> str:
    """Return an exception as one line of text."""
    return f"{type(fault).__name__}: {fault}".replace("\n", " ")


def plugin_failed(plugin: str, package: str, fault: BaseException | str, *labels: Label) -> Diagnostic:
    """Return the error of a plugin at fault.

    plugin  : name for messages, such as "kind `zigzag`"
    package : the Python package that provides the plugin
    fault   : the exception that it raised, or a text that states what is wrong with its result
    labels  : places in the mission, the primary first
    """
    if isinstance(fault, str):
        return Diagnostic("P008", f"{plugin} of package {package} {fault}", labels, help=_help(package))
    where = _where(fault)
    notes = (one_line(fault), *([where] if where else []))
    return Diagnostic("P008", f"{plugin} of package {package} failed", labels, notes, _help(package))


def _help(package: str) -> str:
    return f"report it to the authors of {package}, or do without this plugin"


def _where(fault: BaseException) -> str:
    """Return the innermost place of the traceback outside of shotc, as text; empty if there is none."""
    trace = fault.__traceback__
    place = ""
    while trace is not None:
        code = trace.tb_frame.f_code
        module = trace.tb_frame.f_globals.get("__name__", "")
        if not module.startswith("shotc."):
            place = f"in {code.co_name}, line {trace.tb_lineno} of module {module}"
        trace = trace.tb_next
    return place
