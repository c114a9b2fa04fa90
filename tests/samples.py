"""Plans made by hand, for tests that need one without running the compiler."""

from __future__ import annotations

from math import atan2, pi, radians

import numpy as np

from shotc.geom.bernstein import concatenate, quintic_hermite
from shotc.geom.camera import view
from shotc.geom.solids import Cylinder, Prism
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe, PlacedShot
from shotc.ir.mission import (
    Composition,
    Drone,
    GeoOrigin,
    Gimbal,
    Keyframe,
    Limits,
    MissionIR,
    Promise,
    Rules,
    Shot,
    Target,
    Timing,
    Zone,
)
from shotc.ir.origin import OriginMap
from shotc.ir.trajectory import (
    Claim,
    DroneTrajectory,
    KeyframeTime,
    Phase,
    Reference,
    TrajectoryIR,
    VerifiedIR,
)

CENTER = Composition("center", points=((0.0, 0.0),))


def orbit_mission(*, origin: bool = True) -> MissionIR:
    """A half orbit round a tower, one tree and a field about it."""
    hfov = radians(70)
    keyframes = tuple(
        Keyframe(
            at=(40 * np.cos(a), 40 * np.sin(a), 20.0),
            aim=None,
            target="tower",
            composition=CENTER,
            hfov=hfov,
            hold=0.0,
            time=None,
            placed=True,
            path=("shots", 0, "keyframes", i),
        )
        for i, a in enumerate(np.linspace(-pi / 2, pi / 2, 5))
    )
    shot = Shot(
        id="half",
        kind="keyframes",
        drone="cam1",
        subject="tower",
        keyframes=keyframes,
        timing=Timing(duration=30.0),
        pace=0.75,
        promise=Promise(in_frame=1.0, screen_error=0.05),
        refine_optional=False,
        path=("shots", 0),
    )
    drone = Drone(
        name="cam1",
        model="x500",
        home=(0.0, -60.0, 0.0),
        limits=Limits(8.0, 4.0, 3.0, 3.0, 8.0, radians(60), radians(90)),
        gimbal=Gimbal((radians(-90), radians(30)), (radians(-135), radians(135)), radians(45), radians(90)),
        hfov=hfov,
        aspect=16 / 9,
        radius=0.6,
        endurance=1200.0,
        priority=1,
        body="follow-camera",
        autopilot="px4",
        path=("drones", "cam1"),
    )
    field = Prism(((-80.0, -80.0), (80.0, -80.0), (80.0, 80.0), (-80.0, 80.0)), 2.0, 60.0)
    return MissionIR(
        name="half-orbit",
        origin=GeoOrigin(47.3769, 8.5417, 408.0) if origin else None,
        wind=0.0,
        zones=(
            Zone("tree", "out", Cylinder((-20.0, 10.0), 3.0, 0.0, 12.0), ("world", "zones", "tree")),
            Zone("field", "in", field, ("world", "zones", "field")),
        ),
        targets=(Target("tower", (0.0, 0.0, 12.0), 4.0, 24.0, ("targets", "tower")),),
        drones=(drone,),
        rules=Rules(3.0, 2.0, 1.0),
        shots=(shot,),
        rate=50.0,
        emit=("csv", "mavlink", "rerun"),
        source_sha256="0" * 64,
        deferred=(),
        origins=OriginMap("half-orbit.yaml", {}, {}),
    )


def _move(t0: float, t1: float, a: np.ndarray, b: np.ndarray):
    zero = np.zeros((2, 7))
    return quintic_hermite(np.array([t0, t1]), np.stack([a, b]), zero, zero)


def orbit_plan(*, origin: bool = True) -> VerifiedIR:
    """Take-off, transit, a filmed half orbit, return and landing: C2, within every limit."""
    mission = orbit_mission(origin=origin)
    drone, tower = mission.drones[0], mission.targets[0]

    def pose(azimuth: float) -> np.ndarray:
        p = np.array([40 * np.cos(azimuth), 40 * np.sin(azimuth), 20.0])
        d = np.array(tower.centre) - p
        # The camera goes once through yaw = pi; write it without a wrap.
        yaw = azimuth + pi
        return np.array([*p, yaw, atan2(d[2], np.hypot(d[0], d[1])), yaw, drone.hfov])

    first, last = pose(-pi / 2), pose(pi / 2)
    pad = np.array([0.0, -60.0, 0.0, pi / 2, 0.0, pi / 2, drone.hfov])
    above = pad + np.array([0, 0, 6.0, 0, 0, 0, 0])
    t = np.linspace(0.0, 1.0, 121)
    ease = 10 * t**3 - 15 * t**4 + 6 * t**5
    ease1 = (30 * t**2 - 60 * t**3 + 30 * t**4) / 30.0
    ease2 = (60 * t - 180 * t**2 + 120 * t**3) / 900.0
    azimuth = -pi / 2 + pi * ease
    h = 1e-4
    value = np.array([pose(a) for a in azimuth])
    d1 = np.array([(pose(a + h) - pose(a - h)) / (2 * h) for a in azimuth])
    d2 = np.array([(pose(a + h) - 2 * pose(a) + pose(a - h)) / h**2 for a in azimuth])
    rate, accel = pi * ease1, pi * ease2
    orbit = quintic_hermite(
        22.0 + 30 * t, value, d1 * rate[:, None], d2 * rate[:, None] ** 2 + d1 * accel[:, None]
    )
    back = last.copy()
    back[[3, 5]] = last[3]
    above_back = above.copy()
    above_back[[3, 5]] = last[3]
    pad_back = pad.copy()
    pad_back[[3, 5]] = last[3]
    # Return round the tower in two rest-to-rest moves.
    side = np.array([60.0, 0.0, 20.0, last[3], 0.0, last[3], drone.hfov])
    curve = concatenate(
        [
            _move(0.0, 8.0, pad, above),
            _move(8.0, 22.0, above, first),
            orbit,
            _move(52.0, 82.0, last, side),
            _move(82.0, 112.0, side, above_back),
            _move(112.0, 122.0, above_back, pad_back),
        ]
    )
    phases = (
        Phase("takeoff", None, 0.0, 8.0),
        Phase("transit", None, 8.0, 22.0),
        Phase("shot", "half", 22.0, 52.0),
        Phase("return", None, 52.0, 112.0),
        Phase("land", None, 112.0, 122.0),
    )
    placed = tuple(
        PlacedKeyframe(
            at=k.at,
            yaw=pose(a)[3],
            pitch=pose(a)[4],
            hfov=k.hfov,
            target="tower",
            reference=(0.0, 0.0),
            asked=(0.0, 0.0),
            hold=0.0,
            time=None,
            placed=True,
            path=k.path,
        )
        for k, a in zip(mission.shots[0].keyframes, np.linspace(-pi / 2, pi / 2, 5), strict=True)
    )
    fine = np.linspace(0.0, 1.0, 200_001)
    fine_ease = 10 * fine**3 - 15 * fine**4 + 6 * fine**5
    times = 22 + 30 * np.interp(np.linspace(0.0, 1.0, 5), fine_ease, fine)
    zero = np.zeros((2, 2))
    reference = quintic_hermite(np.array([22.0, 52.0]), zero, zero, zero)
    trajectory = TrajectoryIR(
        keyframes=KeyframeIR(mission, (PlacedShot(mission.shots[0], placed),)),
        drones=(
            DroneTrajectory(
                "cam1",
                curve,
                phases,
                tuple(KeyframeTime("half", i, float(x)) for i, x in enumerate(times)),
                (Reference("half", "tower", 22.0, 52.0, reference),),
            ),
        ),
        deviations=(),
        stats=(),
    )
    claims = (
        Claim(
            "speed",
            "cam1",
            None,
            8.0,
            7.9,
            "m/s",
            True,
            37.0,
            (40.0, 0.0, 20.0),
            "bounded",
            True,
            True,
            ("drones", "cam1", "limits", "speed"),
        ),
    )
    return VerifiedIR(trajectory, claims)


__all__ = ["orbit_mission", "orbit_plan", "view"]
