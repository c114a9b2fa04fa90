"""P: plugins and options."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.model import Severity

CODES: tuple[CodeInfo, ...] = (
    CodeInfo(
        "P001",
        "plugin-clash",
        Severity.ERROR,
        "two packages register one plugin name",
        "Kinds, refiners and emitters are found by name. Where two installed packages claim the same name, shotc "
        "uses neither, since the choice would be a guess; missions that do not name it are not concerned. Remove or "
        "rename one of them.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P002",
        "plugin-broken",
        Severity.ERROR,
        "a plugin cannot be imported",
        "An installed package registers a plugin whose import raises. A mission that names the plugin "
        "cannot be planned or written. Other missions are not affected, and `shotc list` shows the fault. "
        "Update the package, or uninstall it.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P003",
        "plugin-version",
        Severity.ERROR,
        "a plugin was written for another plugin api",
        "A plugin states the api version it was written against, and its own name. Both have to match what this "
        "version of shotc offers. Update the plugin or shotc.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P004",
        "library-not-installed",
        Severity.ERROR,
        "what was asked for needs a library that is not installed",
        "The base install checks missions and explains codes. Planning needs numpy, scipy, Clarabel and others, "
        "which weigh several hundred megabytes and come with the extra `plan`; the rerun recording comes with the extra "
        "`view`, and `all` is both. The help has the command that installs them from where shotc came from.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P005",
        "output-left-out",
        Severity.WARNING,
        "an output needs a library that is not installed",
        "The rerun recording needs rerun-sdk, which weighs half a gigabyte and comes with "
        "`pip install 'shotc[view]'`; it has no release for Intel Macs. The other outputs are written; this one is left out.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P006",
        "not-planned-yet",
        Severity.ERROR,
        "the mission uses a part of the language that this version checks but cannot plan",
        "A shot kind may say of a part of its shot that it is checked and cannot be planned yet. Missions with it can be "
        "written and reviewed; `shotc plan` refuses them instead of flying a part of them. No kind of shotc itself does.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P007",
        "no-refiner",
        Severity.WARNING,
        "planned without a refiner, since none is named and ours is not installed",
        "Without `--refiner` a mission is planned by the refiner `ours`, which keeps the composition "
        "between keyframes and comes with the package shotc-casadi. It is not installed here, so the "
        "convex path is flown as it is: proved like any other, but without a trade-off between framing and "
        "smoothness. Install it, or write `--refiner none` to choose this.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "P008",
        "plugin-failed",
        Severity.ERROR,
        "a plugin raised, or returned a wrong value",
        "A shot kind or an emitter of another package failed. The note has its own words and the place in its code. A "
        "mission whose kind fails is not planned; where an emitter fails, the files of the other emitters are written, and "
        "the exit status is 1. Update the package, report the fault to its authors, or do without the plugin.",
        "",
        "",
        "other",
    ),
)
