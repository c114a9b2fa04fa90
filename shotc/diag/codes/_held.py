"""V040 to V046, V063 to V066: a plan file whose contents contradict its own trajectory or its mission."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._verified import verified

HELD: tuple[CodeInfo, ...] = (
    verified(
        40,
        "certificate-differs",
        (
            "the certificate in the plan is not what the plan proves",
            "`shotc verify` proves every claim again from the trajectory and the limits in the file. Where "
            "a value, a limit or a claim in its certificate differs, something in the file was edited: the "
            "certificate, the trajectory or a limit. A file from another version of shotc may differ in "
            "many claims; then one message says so. The new proof counts; plan the mission again.",
        ),
    ),
    verified(
        41,
        "plan-of-another-mission",
        (
            "the plan differs from its own mission",
            "A plan holds the text of its mission and the tables that it names. `shotc verify` lowers them again, as "
            "`check` does, and holds the plan to all that comes of it: shots, keyframes, holds, times, places on screen, "
            "targets, drones, limits, zones. Here what the plan says differs, so the file was edited, or another version "
            "of shotc wrote it. Plan the mission again.",
        ),
    ),
    verified(
        42,
        "plan-without-its-mission",
        (
            "the mission of a plan cannot be lowered again",
            "What a plan is to do follows from its mission alone, so a plan without one proves nothing: one that an "
            "earlier version of shotc wrote, one whose text or tables were cut out, one with a kind of shot that no "
            "installed package has. Plan the mission again, or install the package.",
        ),
    ),
    verified(
        43,
        "plan-of-another-file",
        (
            "the plan is not the plan of the given mission",
            "`shotc verify PLAN --against MISSION` holds a plan to a file besides the mission in it: the one that is "
            "reviewed, so that no plan of an earlier mission is flown. All that the file asks for is compared, its "
            "tracks and what its displays draw included; comments and the order of keys are free. Plan the file again.",
        ),
    ),
    verified(
        63,
        "no-return",
        (
            "a show cannot be aborted at some time",
            "`shotc verify PLAN --abort-every 1s` has every fleet come home from every second of its show: it brakes along its "
            "common way, goes over its pads and lands. Each return is proved as a plan is, and where the way over the pads has no "
            "room the fleet goes on to its next stop and turns there, or goes back as it came. Here all three break a "
            "limit of the mission, which the note names with its value: often the endurance, late in a show. Give the fleet more "
            "room, time or distance, and plan again.",
        ),
    ),
    verified(
        64,
        "picture-not-as-asked",
        (
            "a fleet shows another picture than the mission asks for",
            "While a picture stands, its lights have the colour that the mission states (white for a shape without one), to one "
            "level of 255, and no more than 95 % of a fleet are dark. Verification draws each text and each solid again. All lights "
            "are on it, all of it has lights, and both have the same middle and width, as far as the number of drones and their "
            "separation allow; the page on outputs has the limits. Pictures of files, and texts in other fonts than the "
            "default one, are not judged so, since a plan does not hold the files; nor are the colours of a file without "
            "`color`. The claim `pictures of a file` counts them. Between two pictures the lights fade evenly, and on the way up "
            "and down they are dark. Every effect of lights is there, in its order, with its blend, colours, times and place, and "
            "no other; which lights sparkle, and the pixels of an image, are left open. Plan the mission again.",
        ),
    ),
    verified(
        65,
        "pace-not-kept",
        (
            "a shot is flown faster than its pace",
            "`pace` is the share of every limit that a shot may use where the mission leaves its time free: of speed, climb "
            "and descent, acceleration and jerk, the turns of body and gimbal, and the zoom rate. Jerk is lower still with a "
            "high `smoothing`. Where several drones fly or a target moves, a refined shot keeps the time of its convex "
            "path and may use 1.25 times its pace, never more than the limits. It is proved at every instant; the note "
            "names the limit. Plan the mission again.",
        ),
    ),
    verified(
        66,
        "time-lost",
        (
            "a flight takes longer than the mission needs",
            "Where the mission leaves time free, a flight is about as fast as it can be. Verification estimates the least time of "
            "each way from its shape and the limits. Between two keyframes a shot takes at most 1.5 times that and half a second; a "
            "shot with a duration is compared with its share of it, so a hold lasts as long as it is asked for. Between shots it "
            "is 3 times, 5 s and the turns, and the way is at most twice the straight line, 100 m, and 4 times the size of what "
            "stands. A drone waits for a `start`, for a shot of `after`, or while somebody is near where it would fly, and at "
            "most 1.5 times that and 3 s. A shot of what moves begins at most 90 s after its drone can be there. Plan the "
            "mission again.",
        ),
    ),
    verified(
        44,
        "path-left-untold",
        (
            "a shot is flown elsewhere than its kind asks, and the plan does not say so",
            "A path that a kind generates is an ideal: planning leaves it where something stands in the "
            "way, or for the picture's sake, and says by how much (`deviations`). No more than that is "
            "allowed, half a metre at its beginning and its end where nothing is near, and half the "
            "distance to the target elsewhere. So an orbit of another sweep, or in the other direction, is "
            "refused. What the plan says is believed as far as the mission explains it: going round what "
            "stands or comes there, half the distance to the target for its picture, and of what moves the "
            "way in which the drone stops. Between placed keyframes the path stays within half of the way "
            "between them of the straight one, in a `follow-path` within a tenth of it (0.5 m to 5 m), and "
            "what stands there. A place that the author gave is left only for the pictures of other drones, "
            "by a fifth of the distance where they are preferred free, and for what comes there. Plan the "
            "mission again.",
        ),
    ),
    verified(
        45,
        "camera-off-its-keyframes",
        (
            "the camera looks elsewhere at a keyframe than the mission asks",
            "At a keyframe the lens is the one that is asked for, a camera that frames nothing has its written "
            "angles, and one that goes round goes round as often as it should. Between two keyframes both stay "
            "between theirs, unless the camera follows a target or the lens zooms to show it. A body that "
            "follows its camera turns with it, and a free one turns hardly more than the gimbal needs. The place of a target on screen has codes of its own (V030, "
            "V032), and held where the shot says `require`. Plan the mission again.",
        ),
    ),
    verified(
        46,
        "promise-not-judged",
        (
            "a shot promises something that the plan cannot be judged by",
            "Every key of `require` has a claim in the certificate. Without a target that is framed, or for "
            "`screen_error` without a place on screen that is wanted, there is none, and the promise would mean nothing. "
            "Remove the key, or give the shot a target and a composition.",
        ),
    ),
)
