"""The standard's minimum of a segment: 20 s, 10 samples a second, whole averaging angles, a vertical axis."""

from __future__ import annotations

from ahrs_lab.messages import Message
from ahrs_lab.recording.clean_rows import RATE_TOLERANCE, CleanRows
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.segment import Segment
from ahrs_lab.recording.table_check import rate_band

MIN_DWELL_S = 20.0
MIN_RATE_HZ = {"zero_offset": 10.0, "misalignment": 10.0, "scale_factor": 1.0}
"""7.2 and 7.3 ask for 10 samples a second; 7.1 samples every second."""
LOST_ANGLE = 0.01
"""Share of a turn's samples that may be bridged."""


def check_minimum(segment: Segment, rows: CleanRows, found: FindingList) -> None:
    """Add a finding for each minimum of JJF 1536 that the segment's rows do not reach."""
    if segment.item not in MIN_RATE_HZ:
        return
    t_s = rows.samples["t_s"]
    seen_s = len(rows.lines) * rows.step_s
    rate_hz = len(rows.lines) / (float(t_s[-1] - t_s[0]) + rows.step_s)
    line = int(rows.lines[-1])
    least = MIN_RATE_HZ[segment.item]
    if rate_hz < least * (1 - RATE_TOLERANCE):
        found.add(
            "sample_rate",
            Message(
                "{rate} samples/s are fewer than the {least} that the standard asks for.",
                rate=float(f"{rate_hz:.4g}"),
                least=least,
            ),
            line,
            "unusable",
        )
    if segment.role == "turns":
        if rows.lost > LOST_ANGLE * len(rows.lines):
            found.add(
                "turns",
                Message.counted(
                    rows.lost,
                    Message("1 sample is missing while the table turned: the angle is not known."),
                    Message(
                        "{lost} samples are missing while the table turned: the angle is not known.",
                        lost=rows.lost,
                    ),
                ),
                line,
                "unusable",
            )
        return
    # Whoever records for 20 s may get a sample less at either end.
    if seen_s < MIN_DWELL_S - 1.5 * rows.step_s:
        found.add(
            "dwell",
            Message(
                "{seen} s of samples are fewer than the {least} s that the standard asks for.",
                seen=round(seen_s, 3),
                least=MIN_DWELL_S,
            ),
            line,
            "unusable",
        )
    elif segment.role == "rate" and segment.rate_dps:
        needed = rate_band(segment.rate_dps).averaging_angle_deg
        turned = abs(segment.rate_dps) * (seen_s + 1.5 * rows.step_s)
        if turned < needed:
            found.add(
                "dwell",
                Message(
                    "{turned}° were turned, fewer than the {needed}° over which the table's rate counts.",
                    turned=round(abs(segment.rate_dps) * seen_s, 3),
                    needed=needed,
                ),
                line,
            )


def check_axis(segment: Segment, found: FindingList) -> None:
    """7.1 and 7.3 turn about the axis that stands vertical."""
    if segment.item in ("scale_factor", "misalignment") and segment.orientation.up_axis != segment.axis:
        found.add(
            "orientation",
            Message(
                "{axis} has to stand vertical, but in the orientation {orientation} it is {vertical}.",
                axis=segment.axis,
                orientation=segment.orientation.letters,
                vertical=segment.orientation.up_axis,
            ),
            0,
            "unusable",
        )
