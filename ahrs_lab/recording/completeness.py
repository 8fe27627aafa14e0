"""What a calibration by JJF 1536 needs and the recording does not have: named by item and axis."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from ahrs_lab.messages import Message
from ahrs_lab.recording.finding import Finding, Severity
from ahrs_lab.recording.orientation import Axis, Orientation
from ahrs_lab.recording.segment import Segment

PROCEDURE = "jjf1536-2015"
FEWEST_RATES = 7
MOST_RATES = 11

TABLE_2: dict[Axis, tuple[str, str, str, str]] = {
    "x": ("ENU", "ESD", "WSU", "WND"),
    "y": ("UEN", "DES", "UWS", "DWN"),
    "z": ("NUE", "SDE", "SUW", "NDW"),
}
"""Table 2 of the standard: positions 1 to 4 of the zero offset of each axis, Y and Z by cyclic exchange."""


_Lack = tuple[Message, Severity]


def missing_segments(segments: Sequence[Segment]) -> tuple[Finding, ...]:
    """A finding per segment that an item and axis with any valid segment still lacks.

    Valid are segments neither superseded nor interrupted. Items and axes nothing was recorded for are not
    missed: a calibration of one axis is one.
    """
    groups: dict[tuple[str, Axis], list[Segment]] = defaultdict(list)
    for segment in segments:
        if not segment.superseded and not segment.interrupted:
            groups[segment.item, segment.axis].append(segment)
    judge = {"scale_factor": _scale_factor, "zero_offset": _zero_offset, "misalignment": _misalignment}
    judge = {"scale_factor": _scale_factor, "zero_offset": _zero_offset, "misalignment": _misalignment}
    return tuple(
        Finding(
            Message("{item} of axis {axis}: {what}", item=_item(item), axis=axis, what=what),
            severity=severity,
            kind="missing",
            item=item,
            axis=axis,
        )
        for (item, axis), members in groups.items()
        if item in judge
        for what, severity in judge[item](members)
    )


def _scale_factor(members: list[Segment]) -> list[_Lack]:
    lacks: list[_Lack] = [
        (
            Message("the recording at rest {when} the rates is missing (role {role}).", when=when, role=role),
            "unusable",
        )
        for role, when in (("static_before", Message("before")), ("static_after", Message("after")))
        if not any(segment.role == role for segment in members)
    ]
    rates = {segment.rate_dps for segment in members if segment.role == "rate"}
    if not FEWEST_RATES <= len(rates) <= MOST_RATES:
        what = Message.counted(
            len(rates),
            Message(
                "1 rate was recorded, the standard asks for {fewest} to {most}.",
                fewest=FEWEST_RATES,
                most=MOST_RATES,
            ),
            Message(
                "{count} rates were recorded, the standard asks for {fewest} to {most}.",
                count=len(rates),
                fewest=FEWEST_RATES,
                most=MOST_RATES,
            ),
        )
        lacks.append((what, "unusable" if len(rates) < FEWEST_RATES else "note"))
    if rates and (min(rates) >= 0 or max(rates) <= 0):
        lacks.append((Message("all rates have the same sense: both are needed."), "unusable"))
    return lacks


def _zero_offset(members: list[Segment]) -> list[_Lack]:
    positions = {segment.position for segment in members if segment.position is not None}
    standard = by_table_2(members)
    expected = 4 if standard else _steps_of_azimuth(members)
    lacks: list[_Lack] = [
        (
            Message("position {position} of {expected} is missing.", position=position, expected=expected),
            "unusable",
        )
        for position in range(1, expected + 1)
        if position not in positions
    ]
    if not standard and len({segment.orientation.face for segment in members}) > 1:
        lacks.append((Message("the positions do not stand as table 2 of the standard says."), "unusable"))
    return lacks


def by_table_2(members: Sequence[Segment]) -> bool:
    """Whether every position stands as table 2 says, for its own axis or (combined schedule) another."""
    return any(
        all(
            segment.position is not None
            and segment.position <= 4
            and segment.orientation == Orientation(letters[segment.position - 1])
            for segment in members
        )
        for letters in TABLE_2.values()
    )


def _steps_of_azimuth(members: list[Segment]) -> int:
    """How many positions a multi-position schedule has: by its smallest step where azimuths are known."""
    highest = max((segment.position or 0 for segment in members), default=0)
    azimuths = sorted(
        {round(segment.azimuth_deg % 360, 3) for segment in members if segment.azimuth_deg is not None}
    )
    if len(azimuths) < 2:
        return highest
    step = min(b - a for a, b in zip(azimuths, [*azimuths[1:], azimuths[0] + 360.0], strict=True))
    return max(highest, round(360.0 / step))


def _misalignment(members: list[Segment]) -> list[_Lack]:
    return [
        (Message("the turns in the {sense} sense are missing.", sense=sense), "unusable")
        for sign, sense in ((1, Message("positive")), (-1, Message("negative")))
        if not any((segment.turns or 0) * sign > 0 for segment in members)
    ]


def _item(item: str) -> Message:
    names = {
        "scale_factor": Message("scale factor"),
        "zero_offset": Message("zero offset"),
        "misalignment": Message("misalignment"),
    }
    return names[item]
