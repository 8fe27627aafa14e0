"""Three small analyses to try the page on, and a recording for them.

Means over windows of a recording at rest, a comparison of two recordings, and a swing that is computed from
its settings alone."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ahrs_lab.analysis.inertial_record import records
from ahrs_lab.analysis.report import Chart, Curve, Mark, Report, Table
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting, Value
from ahrs_lab.messages import Message
from ahrs_lab.recording.orientation import AXES
from ahrs_lab.recording.read import read_bundle

Array = NDArray[np.float64]

CHINESE = {
    "Means at rest": "静止均值",
    "Means of the rates over windows, and how their scatter falls with the window's length. Takes a "
    "recording of at least ten windows at rest.": "角速率的窗口均值及其离散度随窗口长度的变化。"
    "需要至少十个窗口长的静止记录。",
    "recording at rest": "静止记录",
    "window": "窗口长度",
    "unit of the rate": "角速率单位",
    "degrees per second": "度每秒",
    "degrees per hour": "度每小时",
    "remove the mean": "扣除均值",
    "segment": "数据段",
    "empty: the first one": "留空：取第一段",
    "calibration set": "标定参数集",
    "time, s": "时间，s",
    "mean rate, {unit}": "平均角速率，{unit}",
    "scatter, {unit}": "离散度，{unit}",
    "window, s": "窗口，s",
    "Means over {window} s": "{window} s 均值",
    "Scatter of the means": "均值的离散度",
    "axis": "轴",
    "mean": "均值",
    "least": "最小值",
    "greatest": "最大值",
    "white noise": "白噪声",
    "Scatter is the standard deviation of the means; white noise falls with the root of the window.": (
        "离散度为各均值的标准偏差；白噪声随窗口长度的平方根下降。"
    ),
    "{gaps} gaps: windows across them are left out.": "有 {gaps} 处缺失：跨越缺失处的窗口未计入。",
    "{file} lasts {seconds} s, but ten windows need {needed} s: choose shorter windows.": (
        "{file} 时长 {seconds} s，而十个窗口需要 {needed} s：请缩短窗口。"
    ),
    "Comparison": "比对",
    "Difference of two recordings, sample by sample.": "两个记录逐点之差。",
    "reference": "参考记录",
    "unit under test": "被测记录",
    "The recordings have {first} and {second} samples: give two that were taken together.": (
        "两个记录分别有 {first} 和 {second} 个采样：请提供同时采集的记录。"
    ),
    "Damped swing": "阻尼摆动",
    "A pendulum's angle over time, from its period and damping.": "由周期和阻尼计算摆角随时间的变化。",
    "period": "周期",
    "damping": "阻尼比",
    "angle, °": "角度，°",
    "angle": "角度",
    "envelope": "包络",
    "period {seconds} s": "周期 {seconds} s",
}
"""What the screen says in Chinese; a test puts it into the catalogue."""


def mean_rates(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    record = records(read_bundle(bundles[0]), str(settings["segment"]) or None)[0]
    window = float(settings["window_s"])
    seconds = float(record.t_s[-1])
    if seconds < 10 * window:
        raise InputError(
            "{file} lasts {seconds} s, but ten windows need {needed} s: choose shorter windows.",
            file=record.segment.file,
            seconds=f"{seconds:g}",
            needed=f"{10 * window:g}",
        )
    unit, factor = ("°/h", 3600.0) if settings["unit"] == "dph" else ("°/s", 1.0)
    rate = np.degrees(record.rate) * factor
    if settings["remove_mean"]:
        rate = rate - rate.mean(axis=0)
    step = max(1, round(window * record.header.device.sample_rate_hz))
    means = _means(rate, step)
    rate_hz = float(record.header.device.sample_rate_hz)
    t_s = np.asarray((np.arange(len(means)) + 1.0) * step / rate_hz, dtype=np.float64)
    sizes = np.unique(np.geomspace(1, len(rate) // 10, 24).astype(int))
    tau = np.asarray(sizes / record.header.device.sample_rate_hz, dtype=np.float64)
    scatter = np.array([_means(rate, size).std(axis=0, ddof=1) for size in sizes], dtype=np.float64)
    relative = 1.0 / np.sqrt(2.0 * (len(rate) / sizes - 1.0))
    low, high = scatter * (1 - relative[:, np.newaxis]), scatter * (1 + relative[:, np.newaxis])
    deviations = tuple(
        Curve(axis.upper(), tau, scatter[:, i], low[:, i], high[:, i], axis) for i, axis in enumerate(AXES)
    )
    white = Curve(Message("white noise"), tau, scatter[0, 0] * np.sqrt(tau[0] / tau), style="dashed")
    least, greatest = means.min(axis=0), means.max(axis=0)
    rows = tuple(
        (axis.upper(), f"{means[:, i].mean():.4g}", f"{least[i]:.4g}", f"{greatest[i]:.4g}", "-2.5e-07")
        for i, axis in enumerate(AXES)
    )
    report = Report(
        Message("Means at rest"),
        (
            Table(
                Message("Means over {window} s", window=f"{window:g}"),
                (Message("axis"), Message("mean"), Message("least"), Message("greatest"), "σ_x, °/h"),
                rows,
            ),
        ),
        (
            Chart(
                Message("Means over {window} s", window=f"{window:g}"),
                Message("time, s"),
                Message("mean rate, {unit}", unit=unit),
                tuple(Curve(a.upper(), t_s, means[:, i], axis=a) for i, a in enumerate(AXES)),
            ),
            Chart(
                Message("Scatter of the means"),
                Message("window, s"),
                Message("scatter, {unit}", unit=unit),
                (*deviations, white),
                log_x=True,
                log_y=True,
            ),
        ),
        (
            Message(
                "Scatter is the standard deviation of the means; white noise falls with the root of the "
                "window."
            ),
        ),
        (Message("{gaps} gaps: windows across them are left out.", gaps=len(record.gaps)),)
        if len(record.gaps)
        else (),
    )
    series = {"t_s": t_s, **{f"mean_{axis}": means[:, i] for i, axis in enumerate(AXES)}}
    return Outcome({"means": means.tolist()}, report, series)


def _means(values: Array, step: int) -> Array:
    whole = len(values) // step
    return np.asarray(values[: whole * step].reshape(whole, step, 3).mean(axis=1), dtype=np.float64)


def difference(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    del settings
    first, second = (records(read_bundle(bundle))[0] for bundle in bundles)
    if len(first) != len(second):
        raise InputError(
            "The recordings have {first} and {second} samples: give two that were taken together.",
            first=len(first),
            second=len(second),
        )
    return Outcome({"difference": (second.rate - first.rate).tolist()}, Report(Message("Comparison")))


def swing(bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
    del bundles
    period, damping = float(settings["period_s"]), float(settings["damping"])
    t_s = np.linspace(0.0, 60.0, 1201)
    fading = np.exp(-damping * 2 * np.pi * t_s / period)
    angle = 5.0 * fading * np.cos(2 * np.pi * t_s / period)
    chart = Chart(
        Message("Damped swing"),
        Message("time, s"),
        Message("angle, °"),
        (
            Curve(Message("angle"), t_s, angle, -5.0 * fading, 5.0 * fading),
            Curve(Message("envelope"), t_s, 5.0 * fading, style="dashed"),
        ),
        marks=(
            Mark(period, Message("period {seconds} s", seconds=f"{period:g}")),
            Mark(1.1 * period, "1.1 T"),
            Mark(59.5, "59.5 s"),
            Mark(1e4, "far away"),
        ),
    )
    return Outcome({"period_s": period}, Report(Message("Damped swing"), charts=(chart,)))


class Gate:
    """An analysis that waits until it is let through, or ends in a defect."""

    def __init__(self) -> None:
        self.open = threading.Event()
        self.started = threading.Event()
        self.defect = False
        self.asked: list[Value] = []

    def run(self, bundles: Sequence[Path], settings: Mapping[str, Value]) -> Outcome:
        self.asked.append(settings.get("period_s", 10.0))
        self.started.set()
        self.open.wait(20.0)
        if self.defect:
            raise ZeroDivisionError("a defect")
        return swing(bundles, {"period_s": 10.0, "damping": 0.02, **settings})

    def kind(self) -> AnalysisKind:
        return AnalysisKind("gate", Message("Damped swing"), Message("Damped swing"), (), (), self.run)


REST = AnalysisKind(
    "rest",
    Message("Means at rest"),
    Message(
        "Means of the rates over windows, and how their scatter falls with the window's length. Takes a "
        "recording of at least ten windows at rest."
    ),
    (Message("recording at rest"),),
    (
        Setting("window_s", Message("window"), "number", 1.0, unit="s", low=0.1, high=3600.0),
        Setting(
            "unit",
            Message("unit of the rate"),
            "choice",
            "dps",
            choices=(("dps", Message("degrees per second")), ("dph", Message("degrees per hour"))),
        ),
        Setting("remove_mean", Message("remove the mean"), "flag", False),
        Setting("segment", Message("segment"), "text", "", hint=Message("empty: the first one")),
        Setting("set", Message("calibration set"), "file", ""),
    ),
    mean_rates,
)
COMPARISON = AnalysisKind(
    "comparison",
    Message("Comparison"),
    Message("Difference of two recordings, sample by sample."),
    (Message("reference"), Message("unit under test")),
    (),
    difference,
)
SWING = AnalysisKind(
    "swing",
    Message("Damped swing"),
    Message("A pendulum's angle over time, from its period and damping."),
    (),
    (
        Setting("period_s", Message("period"), "number", 12.0, unit="s", low=0.5),
        Setting("damping", Message("damping"), "number", 0.02, high=1.0),
    ),
    swing,
    live=True,
)

HEADER = """format = "ahrs-lab-recording"
version = 1
procedure = "static"
[site]
latitude_deg = 39.9042
[device]
rate_unit = "deg/s"
accel_unit = "m/s^2"
sample_rate_hz = 10.0
[[segment]]
file = "rest.csv"
orientation = "ENU"
item = "static"
"""


def rest_bundle(folder: Path, seconds: float = 120.0) -> Path:
    """A recording at rest with white noise on its rates, and one gap."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "recording.toml").write_text(HEADER, encoding="utf-8")
    noise = np.random.default_rng(7).normal(0.0, (0.01, 0.02, 0.04), (round(10 * seconds), 3))
    rows = [
        f"{(i + 1) / 10:.1f},{0.1 + x:.6f},{-0.2 + y:.6f},{0.05 + z:.6f}"
        for i, (x, y, z) in enumerate(noise.tolist())
        if i not in (50, 51, 52)
    ]
    (folder / "rest.csv").write_text("\n".join(["t_s,gyro_x,gyro_y,gyro_z", *rows]), encoding="utf-8")
    return folder
