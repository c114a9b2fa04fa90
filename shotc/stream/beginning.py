"""The time of day at which mission time 0 is, so that cameras and shows begin together."""

from __future__ import annotations

from datetime import UTC, datetime, time, timedelta

LATEST = timedelta(hours=12)
"""How far ahead a beginning may be: a time of day that has just passed is not that of tomorrow."""


def moment(text: str, now: datetime) -> datetime:
    """Return the moment of a text: `HH:MM` or `HH:MM:SS` of this machine's time zone, or a date and time of
    ISO 8601, with its zone or in this machine's.

    now : with a time zone

    Raise ValueError, which says what is wrong with the text.
    """
    # A later hyphen belongs to the zone: 21:30:00-05:00 is a time of day.
    instant = _dated(text) if "-" in text[:5] else _next(text, now)
    if instant <= now:
        raise ValueError(f"`{text}` was {_span(now - instant)} ago")
    if instant - now > LATEST:
        hours = LATEST.total_seconds() / 3600
        raise ValueError(f"`{text}` is {_span(instant - now)} ahead; at most {hours:g} h are waited")
    return instant


def clock_time(moment: float) -> str:
    """Return a POSIX time as the time of day of this machine, with its offset from UTC."""
    return datetime.fromtimestamp(moment, UTC).astimezone().strftime("%H:%M:%S%z")


def _next(text: str, now: datetime) -> datetime:
    """Return the time of day that is nearest to now, today's, yesterday's or tomorrow's."""
    try:
        if ":" not in text:
            raise ValueError
        of_day = time.fromisoformat(text)
    except ValueError:
        raise ValueError(
            f"`{text}` is no time; write HH:MM:SS, or a date and time as 2026-05-30T21:30:00+02:00"
        ) from None
    today = now.astimezone(of_day.tzinfo).date()
    every = [datetime.combine(today + timedelta(days=k), of_day).astimezone() for k in (-1, 0, 1)]
    return min(every, key=lambda each: abs(each - now))


def _dated(text: str) -> datetime:
    try:
        instant = datetime.fromisoformat(text)
    except ValueError:
        raise ValueError(f"`{text}` is no date and time; write them as 2026-05-30T21:30:00+02:00") from None
    return instant if instant.tzinfo else instant.astimezone()


def _span(span: timedelta) -> str:
    """Return a length of time in words."""
    seconds = span.total_seconds()
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200.0 else f"{seconds / 3600:.1f} h"
