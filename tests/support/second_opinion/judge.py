"""The whole second opinion of one plan."""

from __future__ import annotations

from itertools import tee

from tests.support.second_opinion import asked, framing, measures, reflight, rules, sight, tables
from tests.support.second_opinion.case import Case, Finding, Findings


def judge(case: Case) -> list[Finding]:
    """Return all that is wrong with the files of a plan."""
    return list(findings(case))


def findings(case: Case) -> Findings:
    """Yield what is wrong as it is found; what takes long to look for comes last."""
    kept, claimed = tee(measures.all_measures(case))
    checks = [
        rules.claims_hold(case),
        rules.joints(case),
        rules.phases_in_order(case),
        rules.drones_as_written(case),
        asked.shots_asked(case),
        asked.shots_in_order(case),
        tables.trajectory(case),
        framing.framing_table(case),
        framing.picture_claims(case),
        sight.company(case),
        rules.limits_kept(kept),
        framing.promises(case),
        framing.frames_asked(case),
        rules.claimed(case, claimed),
        reflight.reflights(case),
        framing.hiding(case),
    ]
    for check in checks:
        yield from check
