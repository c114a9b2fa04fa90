"""E: emission, data that an output format cannot represent."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._waypoints import WAYPOINTS
from shotc.diag.model import Severity

_SKYC_CODES = (
    CodeInfo(
        "E111",
        "skyc-needs-origin",
        Severity.WARNING,
        "the show file has no place on the globe, because the mission has no world.origin",
        "A `.skyc` file is in metres about a point of the globe. Without `world.origin` that point is left open: "
        "Skybrush loads and plays the show, and has to be told where it is before it is flown.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E112",
        "skyc-too-large",
        Severity.WARNING,
        "the show file is skipped, because it would have too many drones",
        "Skybrush reads shows of at most 5000 drones: `MAX_DRONE_COUNT` of its loader, "
        "`packages/show-format/src/constants.ts` of github.com/skybrush-io/skybrush.js. All other outputs are written; "
        "`zipped-csv` and `vviz` hold any number.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E113",
        "zone-not-in-skyc-fence",
        Severity.WARNING,
        "a keep-in zone is left out of the show's geofence",
        "The geofence of a show is an area on the map, without height, and it watches the drones from take-off to "
        "landing. A keep-in zone that the pads lie outside of would stop the show on the ground, so it is left out. "
        "The plan keeps the zone all the same.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E150",
        "song-not-carried",
        Severity.WARNING,
        "a show file is without its song",
        "Show files play MP3 alone. A plan does not hold the song, so only `shotc plan`, which has it at hand, puts it into a "
        "show file.",
        "",
        "",
        "other",
    ),
)

_SITE_CODES = (
    CodeInfo(
        "E130",
        "site-needs-origin",
        Severity.WARNING,
        "the map of the site is skipped, because the mission has no world.origin",
        "Pads, zones and the hull of the flight stand on a map by latitudes and longitudes, which count from "
        "`world.origin`. All other outputs are written.",
        "",
        "",
        "other",
    ),
)

_FILE_CODES = (
    CodeInfo(
        "E001",
        "plan-not-json",
        Severity.ERROR,
        "a plan file is not JSON",
        "`shotc verify`, `emit`, `view` and `diff` read the plan.json that `shotc plan` writes. The text stops "
        "being JSON at the place that is named: a file cut short, a copy with a key twice, or some other file.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E002",
        "plan-format",
        Severity.ERROR,
        "a JSON file is not a plan, or one of another version",
        'A plan begins with "format": "shotc-plan" and "version": 1. The trajectory in a plan of another version '
        "may mean something else, so it is not guessed at: plan the mission again with this shotc.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E003",
        "plan-field",
        Severity.ERROR,
        "a field of a plan file is missing, or does not hold what belongs there",
        "Every field of a plan is read strictly: its type, finite numbers, the shape of every table, names that "
        "exist. The path of the field is given, as in `drones[0].limits.speed`. A plan written by shotc has no "
        "such faults, so the file was edited or damaged: plan the mission again.",
        "",
        "",
        "other",
    ),
)

_VIEW_CODES = (
    CodeInfo(
        "E114",
        "output-empty",
        Severity.ERROR,
        "an output that was asked for has no file for this plan",
        "`shotc emit --emit LIST` was asked for an output that cannot be made of this plan: a file of places on the globe "
        "of a mission without an origin, say, or a show file of a mission without a fleet. The notes say why; the other "
        "outputs are written. `shotc plan` leaves such an output out with a warning.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E201",
        "no-viewer",
        Severity.ERROR,
        "`shotc view` needs the rerun viewer, and it is not installed",
        "The recording is shown by the viewer that comes with rerun-sdk, which is not part of the base "
        "install. Install it with `pip install 'shotc[view]'`; storyboard.png shows the same plan without it. There is no "
        "release of it for Intel Macs.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E202",
        "no-display",
        Severity.ERROR,
        "`shotc view` opens a window, and there is no display here",
        "The viewer is a window, and a machine without a screen (a server, a container, a remote shell) cannot "
        "open one. Write the recording with `shotc plan` or `shotc emit`, and open mission.rrd elsewhere, or "
        "serve it to a browser with `rerun --web-viewer mission.rrd`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E203",
        "viewer-failed",
        Severity.ERROR,
        "the rerun viewer ended with an error",
        "The recording was written, but the viewer did not run: most often there is no graphics driver that it "
        "can use. What the viewer itself printed says more; a browser can show the recording instead, with "
        "`rerun --web-viewer mission.rrd`.",
        "",
        "",
        "other",
    ),
)

CODES: tuple[CodeInfo, ...] = (
    *_FILE_CODES,
    *WAYPOINTS,
    *_SKYC_CODES,
    *_SITE_CODES,
    *_VIEW_CODES,
    CodeInfo(
        "E901",
        "outputs-not-written",
        Severity.ERROR,
        "the output files cannot be written",
        "All files of a plan are written beside their places first and renamed when every one of them is whole. "
        "A full disk, a folder that cannot be written to or something else in a file's place stops that, and the "
        "files of an earlier run stay as they were. Free some space, or choose another folder with `-o`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E902",
        "output-made-twice",
        Severity.ERROR,
        "two emitters make a file of one name",
        "Every output file has one maker. Where two installed emitters would write files of the same name, nothing "
        "is written, since one would be lost. Choose the emitters with `--emit` or `output.emit`.",
        "",
        "",
        "other",
    ),
    CodeInfo(
        "E115",
        "one-folder-for-two",
        Severity.ERROR,
        "two missions of a folder would be written to one place",
        "`shotc plan FOLDER` writes every mission into a folder of its name. Two missions have one name, or names that make "
        "one folder, such as `a b` and `a-b`: the second would replace the files of the first, and nobody could tell whose "
        "they are. Nothing is planned.",
        "",
        "",
        "other",
    ),
)
