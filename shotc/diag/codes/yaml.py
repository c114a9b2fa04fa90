"""Y: faults in the text of a mission, found before it has a meaning. See shotc.diag.registry."""

from __future__ import annotations

from typing import Literal

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Diagnostic, Label, Severity
from shotc.source.fault import Fault, FaultKind

_PASSING = """\
shotc: 1
mission: look
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
shots:
  - {id: wide, kind: static, drone: cam1, target: tower, at: [0, -50, 15], look_at: tower, timing: {duration: 5}}
"""


def _code(
    number: int,
    slug: str,
    text: tuple[str, str],
    failing: str,
    phase: Literal["check", "other"] = "check",
) -> CodeInfo:
    summary, explanation = text
    return CodeInfo(f"Y{number:03}", slug, Severity.ERROR, summary, explanation, failing, _PASSING, phase)


def _mutant(old: str, new: str) -> str:
    """Return the passing mission with one error put in."""
    return _PASSING.replace(old, new)


CODES: tuple[CodeInfo, ...] = (
    _code(
        1,
        "not-utf8",
        (
            "the file is not UTF-8 text",
            "Missions are UTF-8 text, with or without a byte order mark. The first byte that is not UTF-8 is "
            "shown with its offset; editors of the 1990s and some Windows tools write Latin-1 or UTF-16. "
            "Save the file again as UTF-8.",
        ),
        _mutant("mission: look", "mission: look # caf\\xe9"),
    ),
    _code(
        2,
        "control-character",
        (
            "a character that YAML does not allow",
            "A NUL, an escape or another control character stands in the text; it comes from a damaged file or "
            "from a copy out of a terminal, and is often invisible in editors. Delete it. Where there are many, "
            "the file is no text at all: perhaps it is a recording or an archive.",
        ),
        _mutant("mission: look", "mission: lo\\x00ok"),
    ),
    _code(
        3,
        "file-too-large",
        (
            "the file has more bytes than a mission may have",
            "A mission of hundreds of shots needs less than a megabyte; the limit of four protects servers and "
            "editors that read missions from others. Keep long tracks and point lists in CSV files beside the "
            "mission and name them there.",
        ),
        "",
        "other",
    ),
    _code(
        4,
        "too-deep",
        (
            "lists and mappings are nested too deep",
            "The language needs fewer than twelve levels; text that nests 64 deep is damaged or was made to bring "
            "a reader down. Nothing below that level is read. Look for brackets that are opened and never closed.",
        ),
        _mutant("at: [0, -50, 15]", "at: " + "[" * 80 + "0" + "]" * 80),
    ),
    _code(
        5,
        "too-many-values",
        (
            "the file holds more values than a mission may have",
            "A mission holds at most 200000 keys and values. Keep long tracks and point lists in CSV files beside "
            "the mission and name them there.",
        ),
        "",
        "other",
    ),
    _code(
        6,
        "alias-expansion",
        (
            "aliases stand for too many values",
            "An alias repeats a whole value, and aliases of aliases multiply: a few lines can stand for millions of "
            "values. All aliases of a mission together may stand for 20000. Write values out, or use fewer aliases.",
        ),
        _PASSING
        + "world:\n  zones: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n  b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
        + "  c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]\n  d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]\n"
        + "  e: [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]\n",
    ),
    _code(
        7,
        "syntax-error",
        (
            "the text is not YAML here",
            "Something stands where YAML allows nothing of the kind: a stray bracket, text behind a value that has "
            "ended, a line without a colon after its key. Reading stops at the first syntax error, so correct it and "
            "check again. Values that hold brackets, colons or quotation marks are safest in quotes.",
        ),
        _mutant("home: [0, -60, 0]}", "home: [0, -60, 0]}}"),
    ),
    _code(
        8,
        "tab-indentation",
        (
            "a tab in the indentation",
            "YAML indents with spaces only, because the width of a tab differs between editors. Replace tabs at the "
            "beginning of lines by spaces; most editors do so for a whole file at once.",
        ),
        _mutant("  cam1:", "\tcam1:"),
    ),
    _code(
        9,
        "bad-indentation",
        (
            "the indentation of a line matches nothing above it",
            "The keys of one mapping, and the items of one list, begin in the same column; what belongs to a key is "
            "indented deeper, and a key that has a value of its own on the line has nothing below it. Move the line "
            "to the column of its siblings. A missing blank after a colon above has the same effect.",
        ),
        _mutant("mission: look", "mission: look\n   wind: 3"),
    ),
    _code(
        10,
        "unclosed",
        (
            "a bracket or a quotation mark is never closed",
            "A list or mapping in brackets, or a quoted text, was opened and the text goes on in a way that cannot "
            "belong to it. The place where it was opened is shown, and the place where reading failed. Add the "
            "closing sign, or the comma that is missing between two values.",
        ),
        _mutant("home: [0, -60, 0]}", "home: [0, -60, 0}"),
    ),
    _code(
        11,
        "needs-quotes",
        (
            "a value that YAML reads as something else without quotes",
            "Values that begin with @, %, a backtick, * or &, or that hold ': ', mean something to YAML, and a # makes "
            "the rest of its line a comment, as it would a colour's digits. Put them in quotes. In double quotes a backslash begins an escape sequence: write it twice, or use single quotes.",
        ),
        _mutant("mission: look", "mission: @look"),
    ),
    _code(
        12,
        "duplicate-key",
        (
            "a key is given twice",
            "One mapping holds each key once; with two, one of the values would be lost without a word. The second "
            "is reported, with the line of the first. Keep one of them, or rename one: two drones need two names.",
        ),
        _mutant("mission: look", "mission: look\nmission: again"),
    ),
    _code(
        13,
        "tag",
        (
            "a tag means nothing in a mission",
            "Words that begin with ! are YAML tags; they ask a reader to build objects of its own, which missions "
            "never need and shotc never does. Delete the tag, or put the value in quotes if the ! belongs to it.",
        ),
        _mutant("mission: look", "mission: !!python/name:os.system look"),
    ),
    _code(
        14,
        "several-documents",
        (
            "the file holds more than one document",
            "A line of three hyphens begins a new YAML document, and a file holds one mission. Everything behind it "
            "is left unread. Keep each mission in a file of its own.",
        ),
        _PASSING + "---\nshotc: 1\n",
    ),
    _code(
        15,
        "empty-file",
        (
            "the file holds no mission",
            "The file is empty, or holds only comments. A mission begins with 'shotc: 1' and 'mission: NAME'; "
            "'shotc new' lists templates to start from.",
        ),
        "# nothing here yet\n",
    ),
    _code(
        16,
        "not-a-mapping",
        (
            "the file holds a list or a single value",
            "At its top level a mission is a mapping of keys to values: shotc, mission, targets, drones, shots. A "
            "file that begins with a hyphen is a list, and one without any colon is a single text.",
        ),
        "- shotc: 1\n- mission: look\n",
    ),
    _code(
        17,
        "merge-key",
        (
            "the key << does not merge",
            "Merging by << was part of YAML 1.1 and is not of YAML 1.2. Write the keys out, use a model for what "
            "drones have in common, or repeat a whole value by alias.",
        ),
        _mutant("{model: x500, home: [0, -60, 0]}", "{<<: {model: x500}, home: [0, -60, 0]}"),
    ),
    _code(
        18,
        "key-not-text",
        (
            "a key is a number, a truth value or null",
            "Keys are names, and names are text: 1, true and null are not. Put them in quotes, or better, choose a "
            "name that says what is meant.",
        ),
        _PASSING.replace("tower", "7"),
    ),
    _code(
        19,
        "complex-key",
        (
            "a key is a list, a mapping or an alias",
            "YAML allows lists and mappings as keys; a mission has no use for them. This is often a template that was "
            "not filled in, such as {{ name }}, or a value that begins with a bracket and needs quotes.",
        ),
        _mutant("mission: look", "{{ key }}: look"),
    ),
    _code(
        20,
        "unknown-alias",
        (
            "an alias names nothing above it",
            "An alias such as *home repeats the value that an anchor &home names, and the anchor has to come first. "
            "Write the anchor, correct the name, or put the value in quotes if the * belongs to it.",
        ),
        _mutant("mission: look", "mission: *look"),
    ),
    _code(
        21,
        "recursive-alias",
        (
            "an alias stands inside its own value",
            "A value that holds itself has no end and cannot be written out. Name an inner part by the anchor "
            "instead, or write out what is meant.",
        ),
        _mutant("cam1: {model: x500,", "cam1: &drone {model: *drone,"),
    ),
    _code(
        22,
        "unreadable-file",
        (
            "the file cannot be read",
            "The file does not exist, is a folder, or may not be read by this user. The reason that the operating "
            "system gives is part of the message. Correct the path; paths are relative to the current folder.",
        ),
        "",
        "other",
    ),
    _code(
        23,
        "no-mission",
        (
            "the folder holds no mission",
            "In a folder, and in the folders below it, files named *.yaml or *.yml with a top-level key 'shotc' are "
            "taken for missions; hidden folders are left out. None was found. Give the file itself to have it "
            "checked whatever it holds.",
        ),
        "",
        "other",
    ),
)

# The code of each kind of fault that the YAML reader reports.
FAULT_CODES: dict[FaultKind, str] = {
    "not-utf8": "Y001",
    "control-character": "Y002",
    "too-large": "Y003",
    "too-deep": "Y004",
    "too-many-values": "Y005",
    "alias-expansion": "Y006",
    "syntax": "Y007",
    "tab-indentation": "Y008",
    "indentation": "Y009",
    "unclosed": "Y010",
    "needs-quotes": "Y011",
    "duplicate-key": "Y012",
    "tag": "Y013",
    "several-documents": "Y014",
    "empty-file": "Y015",
    "not-a-mapping": "Y016",
    "merge-key": "Y017",
    "key-not-text": "Y018",
    "complex-key": "Y019",
    "unknown-alias": "Y020",
    "recursive-alias": "Y021",
}
UNREADABLE_FILE = "Y022"
NO_MISSION = "Y023"


def text_diagnostic(fault: Fault, file: str) -> Diagnostic:
    """Return the diagnostic of a fault of the text of ``file``."""
    related = (Label(file, span, remark) for span, remark in fault.related)
    return Diagnostic(
        FAULT_CODES[fault.kind],
        fault.message,
        (Label(file, fault.span), *related),
        fault.notes,
        fault.help,
    )
