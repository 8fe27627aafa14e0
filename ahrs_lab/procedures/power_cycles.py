"""What belongs together but was recorded over several power-ons, as a resumed run may leave it."""

from __future__ import annotations

from collections.abc import Sequence

from ahrs_lab.messages import Message
from ahrs_lab.recording.segment import Segment

_TOGETHER = {
    "scale_factor": Message("scale factor"),
    "misalignment": Message("misalignment"),
}


def split_over_power_cycles(
    segments: Sequence[Segment], *, off_between_mountings: bool = True
) -> tuple[Message, ...]:
    """A sentence per item and axis whose segments come from more than one power-on: each power-on brings its
    own bias, which 7.1 and 7.3 take as constant. Repeats have power-ons of their own and are compared among
    themselves. An IMU's calibration set is of one power-on as a whole, unless the plan has power off between
    mountings."""
    cycles: dict[tuple[str, str, int], set[int]] = {}
    for segment in segments:
        number = segment.extra.get("power_cycle")
        if segment.item in _TOGETHER and isinstance(number, int):
            if segment.superseded or segment.interrupted:
                continue
            key = (segment.item, segment.axis, int(segment.extra.get("repeat", 1)))
            cycles.setdefault(key, set()).add(number)
    of_imu = {
        segment.extra.get("power_cycle")
        for segment in segments
        if segment.item in ("rotation", "static") and not (segment.superseded or segment.interrupted)
    }
    if len(of_imu) > 1 and not off_between_mountings:
        return (
            Message(
                "Turns and positions were recorded over {count} power-ons; the unit's bias may differ "
                "between them.",
                count=len(of_imu),
            ),
        )
    return tuple(
        Message(
            "{item} of {axis} was recorded over {count} power-ons; the device's bias may differ between "
            "them.",
            item=_TOGETHER[item],
            axis=axis.upper(),
            count=len(numbers),
        )
        for (item, axis, _), numbers in cycles.items()
        if len(numbers) > 1
    )
