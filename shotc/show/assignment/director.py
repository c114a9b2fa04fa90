"""Determines when each picture of a fleet stands, and how long every move takes."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from math import inf

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.ir.fleet import FleetTrajectory, FrameTimes, Recorded
from shotc.ir.mission import MissionIR
from shotc.ir.show import Display, Fleet, Model, Picture
from shotc.show.assignment import faults
from shotc.show.assignment.home import come_home, way_up
from shotc.show.assignment.lights import Images, StandingFrame, rows_of, with_effects
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.order import DroneOrder, OrderedFrame
from shotc.show.assignment.score import FlightScore, Motion
from shotc.show.assignment.swell import Ends
from shotc.show.assignment.waves import Waves

TINY_S = 1e-6
"""Seconds, below which a missed time counts as met."""


class Director:
    """Writes the trajectory of one fleet display by display, as far as the displays it waits for
    are known.
    """

    def __init__(self, mission: MissionIR, fleet: Fleet, cast: DroneOrder) -> None:
        self.mission, self.fleet, self.cast = mission, fleet, cast
        self.score = FlightScore(cast.up.pads)
        self.mover = Mover(mission, fleet)
        self.waves = Waves(mission, fleet, self.mover.sky)
        self.waited = 0.0
        self.levels: tuple[float, ...] = ()
        self._found: list[Diagnostic] = []
        self._displays = [
            (mission.display(name), tuple(scenes))
            for name, scenes in groupby(cast.scenes, key=lambda scene: scene.frame.display)
        ]
        self._done = 0
        self._recorded = {flight.display: flight for flight in cast.recorded}

    def advance(self, ends: dict[str, float]) -> bool:
        """Write the next displays; return whether there were any.

        ends : end times of the displays so far, which are added to
        """
        before = self._done
        while self._done < len(self._displays):
            display, scenes = self._displays[self._done]
            after = display.timing.after
            if after is not None and after not in ends:
                break
            self._present(display, scenes, ends.get(after or "", 0.0))
            ends[display.id] = self.score.clock
            self._done += 1
        return self._done > before

    def finish(self) -> list[Diagnostic]:
        """Write the return of the fleet; return the faults of its times.

        Raise ValueError if displays wait for each other in a circle, which ``check`` refuses.
        """
        if self._done < len(self._displays):
            raise ValueError("displays wait for each other in a circle")
        if self.score.phases[-1].name != "land":
            self.levels = come_home(self.score, self.mover)
        if not self._found and self.score.clock - self.waited > self.fleet.endurance:
            self._found.append(faults.too_long(self.mission, self.fleet, self.score.phases, self.waited))
        return [*self._found, *self.mover.faults, *self.waves.faults]

    @property
    def arcs(self) -> int:
        """Return the number of moves on arcs."""
        return self.score.arcs

    @property
    def lifted(self) -> float:
        """Return the largest rise of the fleet over obstacles between its formations, m."""
        return self.score.lifted

    def trajectory(self, images: Images) -> tuple[FleetTrajectory, list[Diagnostic]]:
        """Return the trajectory with its lights, and diagnostics on their effects."""
        score = self.score
        standing = list(map(StandingFrame, self.cast.scenes, score.shown))
        dark = self._dark()
        rows = rows_of(dark, standing, self._followed())
        lit, faults_of_lights = with_effects(rows, self.mission, standing, dark, images)
        return score.trajectory(self.fleet.name, lit), faults_of_lights

    def _followed(self) -> list[tuple[Recorded, float]]:
        """Return the recorded flights with the time at which each begins."""
        first = {frame.display: frame.start for frame in reversed(self.score.shown)}
        return [(flight, first[flight.display] - flight.shown[0]) for flight in self.cast.recorded]

    def _dark(self) -> tuple[float, float]:
        """Return the end of the dark time at the start, and the beginning of that at the end, seconds."""
        phases, followed = self.score.phases, self._followed()
        up = bool(followed) and followed[0][0].up is not None
        down = bool(followed) and followed[-1][0].down is not None
        begin = followed[0][1] if up else phases[0].end
        return begin, phases[-1].end if down else phases[-1].start

    def _present(self, display: Display, scenes: tuple[OrderedFrame, ...], ready: float) -> None:
        """Write a display with the transit to its first picture, which stands at the display's start."""
        first, score = display.pictures[scenes[0].frame.picture], self.score
        flight = self._recorded.get(display.id)
        if flight is not None and flight.up is not None:
            self.waited = self._wait(display, score.clock + flight.up, ready)
            score.stand(self.waited)
            self._follow(display, flight)
            return
        here = score.places if self._done else self.cast.up.above
        rise = way_up(self.fleet, self.cast.up)
        lead = 0.0 if self._done else rise.duration
        left = inf if display.start is None else display.start - score.clock - lead
        move, duration = self._move_to(display, first, (here, scenes[0].places), left)
        wait = self._wait(display, score.clock + lead + duration, ready)
        score.stand(wait)
        if not self._done:
            self.waited = wait
            score.move(here, rise)
            score.phase("takeoff")
        score.move(scenes[0].places, move, duration)
        score.phase("transit")
        if flight is not None:
            self._follow(display, flight)
            return
        self._pictures(display, scenes)
        score.phase("shot", display.id)

    def _follow(self, display: Display, flight: Recorded) -> None:
        """Write a recorded flight from the fleet's positions, with its take-off and landing if it
        has them.
        """
        score, origin = self.score, self.score.clock
        score.fly(flight.breaks, flight.coef)
        if flight.up is not None:
            score.phase("takeoff", end=round(origin + flight.up, 9))
        score.phase("shot", display.id, None if flight.down is None else round(origin + flight.down, 9))
        if flight.down is not None:
            score.phase("land")
        for index, time in enumerate(flight.shown):
            at = round(origin + time, 9)
            score.shown.append(FrameTimes(display.id, 0, index, at, at))

    def _wait(self, display: Display, earliest: float, ready: float) -> float:
        start = display.start
        if start is None:
            return max(0.0, ready - earliest)
        if start < max(earliest, ready) - TINY_S and not self._found:
            self._found.append(faults.too_early(self.mission, display, max(earliest, ready)))
        return max(0.0, start - earliest)

    def _pictures(self, display: Display, scenes: tuple[OrderedFrame, ...]) -> None:
        before = self.score.clock
        for number, group in groupby(scenes, key=lambda scene: scene.frame.picture):
            picture, frames = display.pictures[number], tuple(group)
            if frames[0] is not scenes[0]:
                left = inf if picture.at is None else picture.at - self.score.clock
                move, duration = self._move_to(display, picture, (self.score.places, frames[0].places), left)
                self._stand_until(picture, duration)
                self.score.move(frames[0].places, move, duration)
            self._show(display, picture, frames)
        if self.score.clock <= before:
            self._found.append(faults.no_time(self.mission, display))

    def _stand_until(self, picture: Picture, duration: float) -> None:
        """Let the picture before one with a fixed time stand until the move to the latter begins."""
        if picture.at is None:
            return
        slack = picture.at - duration - self.score.clock
        if slack < -TINY_S:
            if not self._found:
                earliest = self.score.clock + duration
                self._found.append(faults.too_late(self.mission, picture, earliest, duration))
            return
        self.score.stand(slack)
        self.score.shown[-1] = replace(self.score.shown[-1], end=self.score.clock)

    def _show(self, display: Display, picture: Picture, frames: tuple[OrderedFrame, ...]) -> None:
        score, times = self.score, [self.score.clock]
        period = picture.source.period if isinstance(picture.source, Model) else None
        if len(frames) > 1 and period is not None:
            times += score.animate([scene.places for scene in frames[1:]], period)
        score.stand(picture.hold)
        ends = [*times[:-1], score.clock]
        for scene, start, end in zip(frames, times, ends, strict=True):
            score.shown.append(FrameTimes(display.id, scene.frame.picture, scene.frame.index, start, end))

    def _move_to(self, display: Display, picture: Picture, ends: Ends, left: float) -> tuple[Motion, float]:
        """Return the move to a picture, and its duration.

        left : seconds until the picture has to stand; infinity if its time is free
        """
        move = self._move(display, picture, ends)
        if picture.transition is not None and picture.wave is None:
            return move, self._given(picture, ends, move)
        if move.duration <= left + TINY_S or picture.transition is not None or display.pace == 1.0:
            return move, move.duration
        # A pace holds where the time is free. A time that is given is met with the full limits if necessary.
        full = self._move(display._replace(pace=1.0), picture, ends)
        return full, full.duration if picture.wave is not None else max(full.duration, left)

    def _move(self, display: Display, picture: Picture, ends: Ends) -> Motion:
        """Return the fastest move to a picture at the pace of its display."""
        if picture.wave is not None:
            return self.waves.move(ends, display, picture)
        return self.mover.move(*ends, display.pace, picture)

    def _given(self, picture: Picture, ends: Ends, move: Motion) -> float:
        """Return the given duration of a move, if it is feasible."""
        assert picture.transition is not None
        full = self.mover.move(*ends, 1.0, picture)
        if picture.transition >= full.duration - TINY_S:
            return max(picture.transition, full.duration)
        distance = float(np.linalg.norm((ends[1] - ends[0])[full.drone]))
        self._found.append(faults.too_fast(self.mission, self.fleet, picture, full, distance))
        return full.duration
