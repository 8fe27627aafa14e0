"""Did the table do what the segment says? By its measured angle and rate where recorded, else by the gyro.

Tolerance of a rate is twice what clause 6 allows a table (U_rel 2×10⁻², 2×10⁻³, 2×10⁻⁴ by band), judged over
the angle that the clause averages over, as closely as the times of the table's readings allow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ahrs_lab.messages import Message
from ahrs_lab.recording.clean_rows import CleanRows
from ahrs_lab.recording.finding_list import FindingList
from ahrs_lab.recording.rate_hold import Hold
from ahrs_lab.recording.samples import Array
from ahrs_lab.recording.segment import RateUnit, Segment

REST_NOTE_DEG = 0.01
REST_LIMIT_DEG = 1.0
GYRO_STEADY = 0.05
"""Without any word from the table: how far a second's mean of the gyro may lie from the median, relative."""

_DEG = {"deg/s": 1.0, "rad/s": 180.0 / np.pi}


@dataclass(frozen=True)
class RateBand:
    """A band of clause 6: the angle over which its rate is averaged, and the table's relative U (k = 2)."""

    averaging_angle_deg: float
    relative: float


def rate_band(rate_dps: float) -> RateBand:
    """The band of a rate; below 0.001 °/s and above 1000 °/s the nearest one."""
    size = abs(rate_dps)
    if size < 1:
        return RateBand(1.0, 2e-2)
    return RateBand(10.0, 2e-3) if size < 10 else RateBand(360.0, 2e-4)


def check_table(segment: Segment, rows: CleanRows, rate_unit: RateUnit, found: FindingList) -> None:
    """Compare the table's motion with what was demanded of it; add a finding where they disagree."""
    if segment.item not in ("scale_factor", "zero_offset", "misalignment"):
        return
    if segment.role == "rate":
        _check_rate(segment, rows, found)
    elif segment.role == "turns":
        _check_turns(segment, rows, rate_unit, found)
    else:
        _check_rest(rows, found)


def _check_rate(segment: Segment, rows: CleanRows, found: FindingList) -> None:
    demanded = segment.rate_dps
    t_s, travelled = rows.samples["t_s"], _travelled(rows, demanded)
    if travelled is None:
        travelled = _integrated_rate(rows)
    if travelled is None:
        _check_gyro_steady(segment, rows, found)
        return
    if len(t_s) < 2 or demanded == 0:
        return
    hold = _hold(rows, demanded, travelled)
    mean = hold.wrong_mean()
    if mean is not None:
        found.add(
            "rate",
            Message(
                "the table turned at {mean} °/s, demanded were {demanded} °/s.",
                mean=float(f"{mean:.7g}"),
                demanded=demanded,
            ),
            int(rows.lines[0]),
            "unusable",
        )
        return
    lapse = hold.lapse()
    if lapse is not None:
        found.add(
            "rate",
            Message(
                "the table did not hold its rate: {worst} °/s at {time} s, demanded were {demanded} °/s.",
                worst=float(f"{lapse.rate_dps:.7g}"),
                time=float(t_s[lapse.worst_row]),
                demanded=demanded,
            ),
            int(rows.lines[lapse.first_row]),
        )
    elif hold.reported_dps is None and not hold.angles_tell:
        found.add("rate", _untold(hold), int(rows.lines[0]))


def _hold(rows: CleanRows, demanded: float, travelled: Array) -> Hold:
    doubt = rows.samples.get("table_doubt_s")
    rate = rows.samples.get("table_rate_dps")
    return Hold(
        demanded_dps=demanded,
        tolerance=2 * rate_band(demanded).relative,
        window=_window_rows(demanded, rows.step_s),
        t_s=rows.samples["t_s"],
        travelled_deg=travelled,
        doubt_s=np.zeros(len(travelled)) if doubt is None else np.abs(np.nan_to_num(doubt)),
        reported_dps=rate if rate is not None and np.all(np.isfinite(rate)) else None,
    )


def _untold(hold: Hold) -> Message:
    return Message(
        "whether the table held {demanded} °/s cannot be told closer than {known} %: it tells no rate, and "
        "the times of its angles are known to ±{doubt} s only.",
        demanded=hold.demanded_dps,
        known=float(f"{100 * (hold.tolerance + hold.mean()[1]):.2g}"),
        doubt=float(f"{np.median(hold.doubt_s):.2g}"),
    )


def _check_gyro_steady(segment: Segment, rows: CleanRows, found: FindingList) -> None:
    column = rows.samples.get(f"gyro_{segment.axis}")
    window = max(1, round(1.0 / rows.step_s))
    if column is None or len(column) < 3 * window:
        return
    means = column[: len(column) // window * window].reshape(-1, window).mean(axis=1)
    usual = float(np.median(means))
    off = np.abs(means - usual) > GYRO_STEADY * abs(usual) + 5 * _noise_of_mean(column, window)
    if usual and np.any(off):
        index = int(np.argmax(off))
        found.add(
            "rate",
            Message(
                "the rate is not steady: gyro_{axis} is {mean} over one second, mostly {usual}.",
                axis=segment.axis,
                mean=float(f"{means[index]:.6g}"),
                usual=float(f"{usual:.6g}"),
            ),
            int(rows.lines[index * window]),
            "unusable",
        )


def _noise_of_mean(column: Array, window: int) -> float:
    """Standard deviation of a window's mean by the white noise from row to row."""
    return float(np.median(np.abs(np.diff(column)))) / 0.954 / float(np.sqrt(window))


def _check_turns(segment: Segment, rows: CleanRows, rate_unit: RateUnit, found: FindingList) -> None:
    assert segment.turns is not None
    demanded = 360.0 * segment.turns
    line = int(rows.lines[-1])
    travelled = _travelled(rows, 0.0)
    if travelled is not None:
        turned = float(travelled[-1] - travelled[0])
        off = abs(turned - demanded)
        if off > REST_NOTE_DEG:
            found.add(
                "turns", _turned(turned, segment.turns), line, "unusable" if off > REST_LIMIT_DEG else "note"
            )
        return
    gyro = rows.samples.get(f"gyro_{segment.axis}")
    if gyro is None or rate_unit not in _DEG:
        return
    # K is not known here: only what no scale factor explains counts.
    turned = float(np.sum(gyro * np.diff(rows.samples["t_s"], prepend=rows.samples["t_s"][0] - rows.step_s)))
    turned *= _DEG[rate_unit]
    if abs(turned - demanded) > max(180.0, 0.05 * abs(demanded)):
        found.add("turns", _turned(turned, segment.turns), line, "unusable")


def _turned(turned_deg: float, turns: int) -> Message:
    turned, demanded = round(turned_deg, 3), 360 * turns
    return Message.counted(
        abs(turns),
        Message(
            "{turned}° were turned, not {turns} whole turn ({demanded}°).",
            turned=turned,
            turns=turns,
            demanded=demanded,
        ),
        Message(
            "{turned}° were turned, not {turns} whole turns ({demanded}°).",
            turned=turned,
            turns=turns,
            demanded=demanded,
        ),
    )


def _check_rest(rows: CleanRows, found: FindingList) -> None:
    travelled = _travelled(rows, 0.0)
    if travelled is None:
        return
    window = max(1, round(1.0 / rows.step_s))
    whole = len(travelled) // window * window
    means = travelled[:whole].reshape(-1, window).mean(axis=1) if whole else travelled
    away = np.abs(means - means[0])
    if len(away) and float(np.max(away)) > REST_NOTE_DEG:
        index = int(np.argmax(away > REST_NOTE_DEG))
        found.add(
            "rest",
            Message("the table was to rest, but moved by {moved}°.", moved=round(float(np.max(away)), 4)),
            int(rows.lines[index * window]),
            "unusable" if float(np.max(away)) > REST_LIMIT_DEG else "note",
        )


def _window_rows(rate_dps: float, step_s: float) -> int:
    """Rows over which the clause averages; at least a second, so that time stamps need not be fine."""
    seconds = max(rate_band(rate_dps).averaging_angle_deg / abs(rate_dps), 1.0)
    return max(1, int(np.ceil(seconds / step_s - 1e-9)))


def _travelled(rows: CleanRows, rate_dps: float) -> Array | None:
    """The table's angle, unwrapped about a motion at ``rate_dps``; None where it is not always recorded."""
    angle = rows.samples.get("table_angle_deg")
    if angle is None or not np.all(np.isfinite(angle)):
        return None
    even = rate_dps * rows.samples["t_s"]
    return np.asarray(np.unwrap(angle - even, period=360.0) + even)


def _integrated_rate(rows: CleanRows) -> Array | None:
    rate = rows.samples.get("table_rate_dps")
    if rate is None or not np.all(np.isfinite(rate)):
        return None
    return np.asarray(
        np.cumsum(rate * np.diff(rows.samples["t_s"], prepend=rows.samples["t_s"][0] - rows.step_s))
    )
