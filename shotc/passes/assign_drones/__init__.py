"""assign-drones: LoadedMission to LoadedMission, every `drone: auto` replaced by a drone.

It takes a mission of valid form. It gives it with the choice of drones that films everything in time, as far
as possible by drones that can film it as it is asked. Among these choices it takes the least work for the
busiest drone, then the least distance. No drone has to be in two places at once. If there is no such choice,
the error states when more drones are needed than exist. If the least work alone would take a drone that
cannot film a shot, a warning says why another one films it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, ClassVar, Final

from shotc.diag.model import Diagnostic
from shotc.ir.passes import Outcome, PassContext
from shotc.kinds.base import Kind
from shotc.passes.assign_drones.tasks import busiest, later, tasks_of
from shotc.passes.resolve.lower.names import AUTO, nobody
from shotc.spec.load import LoadedMission

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.passes.assign_drones.choice import Choice
    from shotc.passes.assign_drones.tasks import ShotTask


class AssignDrones:
    """The pass; kinds : every installed shot kind, by name."""

    name: ClassVar[str] = "assign-drones"

    def __init__(self, kinds: Mapping[str, Kind]) -> None:
        self.kinds: Final = kinds

    def run(self, ir: LoadedMission, ctx: PassContext) -> Outcome[LoadedMission]:
        """Choose the drones of one mission; a mission without open drones is unchanged, and loads no
        solver.
        """
        spec = ir.spec
        if not any(shot.drone == AUTO for shot in spec.shots):
            return Outcome(ir)
        from shotc.passes.assign_drones.choice import choose

        ctx.progress("choosing drones")
        if not spec.drones:
            return Outcome(None, tuple(nobody(spec, ir.origins)))
        tasks = tasks_of(ir, self.kinds)
        if tasks is None:
            # A shot is invalid with any drone, and resolve reports it.
            first = next(iter(spec.drones))
            return Outcome(_with(ir, dict.fromkeys(range(len(spec.shots)), first)))
        choice = choose(tasks, tuple(spec.drones))
        if choice is None:
            return Outcome(None, (_too_few(ir, tasks),))
        return Outcome(_with(ir, choice), tuple(_passed_over(ir, tasks, choice)))


def _passed_over(ir: LoadedMission, tasks: tuple[ShotTask, ...], choice: Choice) -> Iterator[Diagnostic]:
    """Yield a warning for each shot that the drone of the least work cannot film as it is asked."""
    if not any(task.refused for task in tasks):
        return
    from shotc.passes.assign_drones.choice import choose

    least_work = choose([task._replace(refused={}) for task in tasks], tuple(ir.spec.drones))
    assert least_work is not None, "it has a choice with fewer refused shots"
    for task in tasks:
        other, chosen = least_work[task.number], choice[task.number]
        fault = task.refused.get(other)
        if fault is not None and other != chosen:
            why = f"by `{other}`, the choice of the least work: {fault.message} ({fault.code})"
            yield Diagnostic(
                "K023",
                f"`{chosen}` films shot `{task.id}`, because `{other}` cannot film it as it is asked",
                (ir.origins.value(("shots", task.number, "drone")),),
                (why, *fault.notes[:1]),
                f"write `drone: {chosen}` to confirm that",
            )


def _with(ir: LoadedMission, choice: Choice) -> LoadedMission:
    shots = tuple(
        shot.model_copy(update={"drone": choice[i]}) if shot.drone == AUTO else shot
        for i, shot in enumerate(ir.spec.shots)
    )
    drones = ((shot.id, choice[i]) for i, shot in enumerate(ir.spec.shots) if shot.drone == AUTO)
    chosen = ir.chosen._replace(drones=tuple(drones))
    return ir._replace(spec=ir.spec.model_copy(update={"shots": shots}), chosen=chosen)


def _too_few(ir: LoadedMission, tasks: tuple[ShotTask, ...]) -> Diagnostic:
    time, busy = busiest(tasks)
    shots = ", ".join(f"`{task.id}`" for task in busy)
    number = len(ir.spec.drones)
    labels = tuple(ir.origins.value(("shots", task.number, "id")) for task in busy)
    if len(busy) > number:
        there = "there is 1 drone" if number == 1 else f"there are {number} drones"
        message = f"{len(busy)} shots are filmed at t = {time:.1f} s, and {there}"
        return Diagnostic("K014", message, labels, (f"they are {shots}",), f"add a drone, or {later(busy)}")
    return Diagnostic(
        "K014",
        "no choice of drones films every shot in time",
        labels,
        (f"most goes on at t = {time:.1f} s: {shots}; ways and endurance count, too",),
        "add a drone, move a shot in time, or bring a home nearer",
    )
