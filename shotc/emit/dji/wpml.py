"""WPML: ``template.kml`` and ``waylines.wpml`` of one mission, with elements in the order of DJI's apps."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from itertools import count

from shotc.emit.waypoints.link import DJI_ACTIONS, return_height
from shotc.emit.waypoints.route import Waypoint
from shotc.ir.drone import Drone, Safety
from shotc.ir.photos import Photos

KML = "http://www.opengis.net/kml/2.2"
CREATED_MS = 1704067200000  # 2024-01-01; a constant, so that the same plan gives the same bytes
APPROACH_M_S = 5.0  # m/s on the way to the first point, which is above the pad
LEAST_CLIMB_M = 1.2  # metres, least height to which DJI Pilot 2 climbs before it flies to the first point
STOP = "toPointAndStopWithContinuityCurvature"
PASS = "toPointAndPassWithContinuityCurvature"


@dataclass(frozen=True, slots=True)
class AppDialect:
    """The WPML dialect of one app.

    namespace : of WPML
    drone, payload : type and subtype numbers; payload is None where the app writes none
    full_template : whether the app makes the flown file anew from the template, which then has to hold
        everything
    group_mode : mode of action groups without a stay
    yaw_base : reference of gimbal yaw angles
    evenly : trigger of the gimbal's even rotation over a leg
    """

    namespace: str
    drone: tuple[int, int]
    payload: tuple[int, int] | None
    full_template: bool
    group_mode: str
    yaw_base: str
    evenly: str


# Tools write 68 for all machines of DJI Fly; the app does not read it.
DJI_FLY = AppDialect(
    "http://www.uav.com/wpmz/1.0.2", (68, 0), None, False, "parallel", "aircraft", "reachPoint"
)
PILOT_2 = AppDialect(
    "http://www.dji.com/wpmz/1.0.6", (77, 0), (66, 0), True, "sequence", "north", "betweenAdjacentPoints"
)
"""The numbers are those of a Mavic 3 Enterprise and its camera."""

PROFILES = {"dji-fly": DJI_FLY, "pilot-2": PILOT_2}


def profile_of(drone: Drone) -> AppDialect:
    """Return the dialect of the app that flies a drone."""
    return PROFILES[drone.autopilot]


@dataclass(frozen=True, slots=True)
class WpmlMission:
    """The points of a mission and an app's dialect, from which both files are written."""

    points: list[Waypoint]
    profile: AppDialect
    safety: Safety

    def template(self) -> bytes:
        """Return ``template.kml``."""
        kml, document = self._root()
        self._put(document, "author", "fly" if not self.profile.full_template else "shotc")
        self._put(document, "createTime", CREATED_MS)
        self._put(document, "updateTime", CREATED_MS)
        self._config(document)
        if self.profile.full_template:
            self._template_folder(document)
        return _bytes(kml)

    def waylines(self) -> bytes:
        """Return ``waylines.wpml``."""
        kml, document = self._root()
        self._config(document)
        folder = ET.SubElement(document, _kml("Folder"))
        self._put(folder, "templateId", 0)
        self._put(folder, "executeHeightMode", "relativeToStartPoint")
        self._put(folder, "waylineId", 0)
        self._put(folder, "distance", 0)
        self._put(folder, "duration", 0)
        self._put(folder, "autoFlightSpeed", self._cruise)
        if self.profile.full_template:
            self._put(folder, "realTimeFollowSurfaceByFov", 0)
        ids = count(1)
        for i in range(len(self.points)):
            self._placemark(ET.SubElement(folder, _kml("Placemark")), i, ids)
        return _bytes(kml)

    @property
    def _cruise(self) -> str:
        return f"{max(p.speed for p in self.points):.2f}"

    def _root(self) -> tuple[ET.Element, ET.Element]:
        kml = ET.Element(_kml("kml"))
        return kml, ET.SubElement(kml, _kml("Document"))

    def _put(self, parent: ET.Element, name: str, value: object = None) -> ET.Element:
        element = ET.SubElement(parent, f"{{{self.profile.namespace}}}{name}")
        if value is not None:
            element.text = str(value)
        return element

    def _config(self, document: ET.Element) -> None:
        """Write how the mission begins and ends.

        The drone lands where the mission ends, which is above its pad. A return to home would climb and fly a
        path that is not verified.
        """
        config = self._put(document, "missionConfig")
        self._put(config, "flyToWaylineMode", "safely")
        self._put(config, "finishAction", "autoLand")
        lost = self.safety.link_lost or "return"
        self._put(config, "exitOnRCLost", "goContinue" if lost == "continue" else "executeLostAction")
        self._put(config, "executeRCLostAction", DJI_ACTIONS[lost])
        if self.profile.full_template:
            climb = max(self.points[0].place.alt, LEAST_CLIMB_M)
            self._put(config, "takeOffSecurityHeight", f"{climb:.1f}")
        self._put(config, "globalTransitionalSpeed", f"{APPROACH_M_S:g}")
        if self.profile.full_template:
            self._put(
                config,
                "globalRTHHeight",
                f"{return_height(max(p.place.alt for p in self.points), self.safety):.0f}",
            )
        drone = self._put(config, "droneInfo")
        self._put(drone, "droneEnumValue", self.profile.drone[0])
        self._put(drone, "droneSubEnumValue", self.profile.drone[1])
        if self.profile.full_template:
            self._put(config, "waylineAvoidLimitAreaMode", 0)
        if self.profile.payload is not None:
            payload = self._put(config, "payloadInfo")
            self._put(payload, "payloadEnumValue", self.profile.payload[0])
            self._put(payload, "payloadSubEnumValue", self.profile.payload[1])
            self._put(payload, "payloadPositionIndex", 0)

    def _template_folder(self, document: ET.Element) -> None:
        """Write the points in the form that DJI Pilot 2 edits; the app makes the flown file from it."""
        folder = ET.SubElement(document, _kml("Folder"))
        self._put(folder, "templateType", "waypoint")
        self._put(folder, "templateId", 0)
        system = self._put(folder, "waylineCoordinateSysParam")
        self._put(system, "coordinateMode", "WGS84")
        self._put(system, "heightMode", "relativeToStartPoint")
        self._put(folder, "autoFlightSpeed", self._cruise)
        self._put(folder, "gimbalPitchMode", "usePointSetting")
        self._put(folder, "globalHeight", f"{self.points[0].place.alt:.2f}")
        self._heading(folder, "globalWaypointHeadingParam", self.points[0])
        self._put(folder, "globalWaypointTurnMode", PASS)
        self._put(folder, "globalUseStraightLine", 0)
        ids = count(1)
        for i, point in enumerate(self.points):
            mark = ET.SubElement(folder, _kml("Placemark"))
            self._point(mark, i)
            height = f"{point.place.alt:.2f}"
            self._put(mark, "ellipsoidHeight", height)
            self._put(mark, "height", height)
            self._put(mark, "useGlobalHeight", 0)
            self._put(mark, "useGlobalSpeed", 0)
            self._put(mark, "waypointSpeed", f"{point.speed:.2f}")
            self._put(mark, "useGlobalHeadingParam", 0)
            self._heading(mark, "waypointHeadingParam", point)
            self._put(mark, "useGlobalTurnParam", 0)
            self._turn(mark, point)
            self._put(mark, "useStraightLine", 0)
            self._put(mark, "gimbalPitchAngle", f"{point.pitch:.1f}")
            self._put(mark, "isRisky", 0)
            self._actions(mark, i, ids)

    def _placemark(self, mark: ET.Element, i: int, ids: count[int]) -> None:
        point = self.points[i]
        self._point(mark, i)
        self._put(mark, "executeHeight", f"{point.place.alt:.2f}")
        self._put(mark, "waypointSpeed", f"{point.speed:.2f}")
        self._heading(mark, "waypointHeadingParam", point)
        self._turn(mark, point)
        self._put(mark, "useStraightLine", 0)
        if self.profile.full_template:
            self._gimbal_heading(mark, point)
            self._put(mark, "isRisky", 0)
        self._actions(mark, i, ids)
        if self.profile.full_template:
            self._put(mark, "waypointWorkType", 0)
        else:
            self._gimbal_heading(mark, point)

    def _point(self, mark: ET.Element, i: int) -> None:
        place = self.points[i].place
        coordinates = ET.SubElement(ET.SubElement(mark, _kml("Point")), _kml("coordinates"))
        coordinates.text = f"{place.lon:.9f},{place.lat:.9f}"
        self._put(mark, "index", i)

    def _heading(self, parent: ET.Element, name: str, point: Waypoint) -> None:
        heading = self._put(parent, name)
        self._put(heading, "waypointHeadingMode", "smoothTransition")
        self._put(heading, "waypointHeadingAngle", _degrees(point.heading))
        self._put(heading, "waypointPoiPoint", "0.000000,0.000000,0.000000")
        self._put(heading, "waypointHeadingAngleEnable", 1)
        self._put(heading, "waypointHeadingPathMode", "followBadArc")  # the shortest turn
        self._put(heading, "waypointHeadingPoiIndex", 0)

    def _turn(self, mark: ET.Element, point: Waypoint) -> None:
        turn = self._put(mark, "waypointTurnParam")
        self._put(turn, "waypointTurnMode", STOP if point.stops else PASS)
        self._put(turn, "waypointTurnDampingDist", 0)

    def _gimbal_heading(self, mark: ET.Element, point: Waypoint) -> None:
        # A pitch of 0 here makes some gimbals level the camera at every point.
        gimbal = self._put(mark, "waypointGimbalHeadingParam")
        self._put(gimbal, "waypointGimbalPitchAngle", f"{point.pitch:.1f}")
        self._put(gimbal, "waypointGimbalYawAngle", 0)

    def _actions(self, mark: ET.Element, i: int, ids: count[int]) -> None:
        """Write the actions at a point, then the even rotation of the gimbal on the next leg.

        A group with a stay is a sequence, because the stay has its place between start and stop of a
        recording.
        """
        point = self.points[i]
        if i == 0:
            group = self._group(mark, ids, (0, 0), self.profile.group_mode, "reachPoint")
            self._rotate(group, ids, point.pitch)
        actions = [action for action in point.actions if action.photos is None]
        if actions:
            stays = any(a.kind == "stay" for a in actions)
            mode = "sequence" if stays or len(actions) > 1 else self.profile.group_mode
            group = self._group(mark, ids, (i, i), mode, "reachPoint")
            for action in actions:
                if action.kind == "stay":
                    self._put(self._action(group, ids, "hover"), "hoverTime", f"{action.seconds:.1f}")
                    continue
                if action.kind == "zoom":
                    params = self._action(group, ids, "zoom")
                    self._put(params, "focalLength", f"{action.focal:.1f}")
                    self._put(params, "isUseFocalFactor", 0)
                    self._put(params, "payloadPositionIndex", 0)
                    continue
                params = self._action(group, ids, "startRecord" if action.kind == "start" else "stopRecord")
                self._put(params, "payloadPositionIndex", 0)
        for action in point.actions:
            if action.photos is not None and action.kind == "start":
                self._photograph(mark, i, ids, action.photos)
        if i + 1 < len(self.points):
            mode = self.profile.group_mode
            group = self._group(mark, ids, (i, i + 1), mode, self.profile.evenly)
            params = self._action(group, ids, "gimbalEvenlyRotate")
            self._put(params, "gimbalPitchRotateAngle", f"{self.points[i + 1].pitch:.1f}")
            self._put(params, "payloadPositionIndex", 0)

    def _photograph(self, mark: ET.Element, i: int, ids: count[int], photos: Photos) -> None:
        """Write a group of photos from a point to the point at which they stop."""
        end = next(k for k in range(i + 1, len(self.points)) if _stops_photos(self.points[k]))
        trigger = "multipleDistance" if photos.seconds is None else "multipleTiming"
        every = photos.metres if photos.seconds is None else photos.seconds
        group = self._group(mark, ids, (i, end), self.profile.group_mode, trigger, every)
        params = self._action(group, ids, "takePhoto")
        self._put(params, "payloadPositionIndex", 0)

    def _group(
        self,
        mark: ET.Element,
        ids: count[int],
        span: tuple[int, int],
        mode: str,
        trigger: str,
        every: float | None = None,
    ) -> ET.Element:
        group = self._put(mark, "actionGroup")
        self._put(group, "actionGroupId", next(ids))
        self._put(group, "actionGroupStartIndex", span[0])
        self._put(group, "actionGroupEndIndex", span[1])
        self._put(group, "actionGroupMode", mode)
        trigger_node = self._put(group, "actionTrigger")
        self._put(trigger_node, "actionTriggerType", trigger)
        if every is not None:
            self._put(trigger_node, "actionTriggerParam", f"{every:g}")
        return group

    def _action(self, group: ET.Element, ids: count[int], name: str) -> ET.Element:
        """Append an action with a unique number and return its parameters."""
        action = self._put(group, "action")
        self._put(action, "actionId", next(ids))
        self._put(action, "actionActuatorFunc", name)
        return self._put(action, "actionActuatorFuncParam")

    def _rotate(self, group: ET.Element, ids: count[int], pitch: float) -> None:
        params = self._action(group, ids, "gimbalRotate")
        self._put(params, "gimbalHeadingYawBase", self.profile.yaw_base)
        self._put(params, "gimbalRotateMode", "absoluteAngle")
        for axis, enable, angle in (("Pitch", 1, f"{pitch:.1f}"), ("Roll", 0, "0"), ("Yaw", 0, "0")):
            self._put(params, f"gimbal{axis}RotateEnable", enable)
            self._put(params, f"gimbal{axis}RotateAngle", angle)
        self._put(params, "gimbalRotateTimeEnable", 0)
        self._put(params, "gimbalRotateTime", 0)
        self._put(params, "payloadPositionIndex", 0)


def _stops_photos(point: Waypoint) -> bool:
    return any(action.kind == "stop" and action.photos is not None for action in point.actions)


def _kml(name: str) -> str:
    return f"{{{KML}}}{name}"


def _degrees(angle: float) -> str:
    """Return an angle in degrees rounded to a tenth, in [-180, 180)."""
    tenth = round(angle, 1)
    return f"{-180.0 if tenth >= 180.0 else tenth:.1f}"


def _bytes(kml: ET.Element) -> bytes:
    ET.indent(kml)
    return bytes(ET.tostring(kml, encoding="UTF-8", xml_declaration=True)) + b"\n"
