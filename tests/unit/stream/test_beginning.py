"""The time of day at which a flight begins."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta, timezone

import pytest

from shotc.stream.beginning import clock_time, moment

NOW = datetime(2026, 5, 30, 19, 0, tzinfo=UTC)
SUMMER = timezone(timedelta(hours=2))


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("19:05+00:00", NOW + timedelta(minutes=5)),
        ("21:30:00+02:00", NOW + timedelta(minutes=30)),
        ("01:00:00Z", NOW + timedelta(hours=6)),
        ("14:30:00-05:00", NOW + timedelta(minutes=30)),
        ("00:10+03:00", NOW + timedelta(hours=2, minutes=10)),
        ("2026-05-30T21:30:00+02:00", NOW + timedelta(minutes=30)),
        ("2026-05-31T06:00:00Z", NOW + timedelta(hours=11)),
    ],
)
def test_a_time_of_day_is_the_next_one_and_a_date_says_which(text, wanted):
    assert moment(text, NOW) == wanted


def test_a_time_without_a_zone_is_of_this_machine():
    here = (NOW + timedelta(minutes=7)).astimezone()
    assert moment(here.strftime("%H:%M:%S"), NOW) == here
    assert moment(here.strftime("%Y-%m-%dT%H:%M:%S"), NOW) == here
    assert clock_time(here.timestamp()).startswith(here.strftime("%H:%M:%S"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("18:59:30Z", "was 30 s ago"),
        ("18:30Z", "was 30 min ago"),
        ("2026-05-29T21:30:00Z", "was 21.5 h ago"),
        ("2026-05-31T21:30:00Z", "is 26.5 h ahead; at most 12 h are waited"),
        ("21", "is no time"),
        ("25:00", "is no time"),
        ("soon", "is no time"),
        ("2026-13-01T10:00", "is no date and time"),
    ],
)
def test_what_is_over_too_far_ahead_or_no_time_is_refused(text, words):
    with pytest.raises(ValueError, match=words):
        moment(text, NOW)
