"""The original record holds the standard's tables as filled, and the plots what they should."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ahrs_lab.certificates.job_sheet import JobSheet
from ahrs_lab.certificates.original_record import original_record_pdf
from ahrs_lab.certificates.plots import plots_pdf
from ahrs_lab.certificates.record_parts import column_figures, figure
from ahrs_lab.certificates.richtext import number_of, text_of
from ahrs_lab.metrology.result import CalibrationResult
from tests.certificates.conftest import BUNDLE_SHA256
from tests.certificates.pdf_text import lines, spans, whole_text
from tests.certificates.test_layout import outside, overlapping

NOTES = {
    "order_run": ["sf_x_before", "sf_x_00", "zo_x_1"],
    "started_utc": "2026-11-22T08:00:00+00:00",
    "finished_utc": "2026-11-22T15:01:02+00:00",
    "repeated": [{"segment": "sf_x_03", "reason": "the table tripped"}],
    "plan": {"name": "JJF 1536-2015", "scale_factor": {"rates_dps": [10.0, -10.0], "dwell_s": 20.0}},
}


@pytest.fixture
def noted(result: CalibrationResult) -> CalibrationResult:
    return replace(result, notes=NOTES)


def test_table_2_has_the_standards_words(tmp_path: Path, noted: CalibrationResult, job: JobSheet) -> None:
    printed = lines(original_record_pdf(noted, tmp_path / "r.pdf", job, "zh"))
    start = printed.index("表 2  X 轴零偏校准结果记录")
    rows = [line.split()[:4] for line in printed[start + 2 : start + 6]]
    assert rows == [
        ["1", "东", "北", "天"],
        ["2", "东", "南", "地"],
        ["3", "西", "南", "天"],
        ["4", "西", "北", "地"],
    ]


def test_table_2_angles_are_the_results(tmp_path: Path, noted: CalibrationResult, job: JobSheet) -> None:
    printed = lines(original_record_pdf(noted, tmp_path / "r.pdf", job, "zh"))
    start = printed.index("表 2  X 轴零偏校准结果记录")
    rows = zip(printed[start + 2 : start + 6], noted.zero_offset["x"].angles_deg, strict=True)
    for position, (line, angle) in enumerate(rows, 1):
        name, _, printed_angle = line.partition(" = ")
        assert name.split()[-1] == f"Nx{position}"
        assert number_of(printed_angle) == pytest.approx(angle, abs=1e-9)


def test_table_3_has_both_senses_and_the_cross_outputs(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet
) -> None:
    printed = lines(original_record_pdf(noted, tmp_path / "r.pdf", job, "zh"))
    start = printed.index("表 3  X 轴失准角校准结果记录")
    heading, positive, negative = printed[start + 1 : start + 4]
    assert "Y 轴输出角度值 Nyx" in heading
    assert "Z 轴输出角度值 Nzx" in heading
    assert positive.startswith("X+ 100 10 41 −0.667 861 107")
    assert negative.startswith("X− 100 10 41 1.267 861 107")


def test_the_rate_table_is_in_the_order_run_with_residuals(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet
) -> None:
    printed = lines(original_record_pdf(noted, tmp_path / "r.pdf", job, "zh"))
    start = printed.index("标度因数记录（7.1），X 轴")
    rows = [line.split()[:2] for line in printed[start + 2 : start + 12]]
    assert rows == [[str(i), r.replace("-", "−")] for i, r in enumerate(
        ["10", "-10", "50", "-50", "100", "-100", "200", "-200", "300", "-300"], 1)]  # fmt: skip
    assert "Fs = 0.000 12 °/s，Fe = 0.000 14 °/s，Fr = 0.000 13 °/s" in printed[start + 12]


@pytest.mark.parametrize(
    "words",
    [
        BUNDLE_SHA256,
        "ahrs-lab 0.1.0",
        "2026-11-22 08:00:00 UTC",
        "2026-11-22 15:01:02 UTC",
        "演示校准员",
        "演示核验员",
        "sf_x_before, sf_x_00, zo_x_1",
        "sf_x_03 the table tripped",
        "sf_x_00 3 The unit was warm",
        "The dwell is shorter",
        "标度因数：每个速率点的时间 / s 20.0",
        "温度 (20.3 ± 0.4) °C",
    ],
)
def test_the_course_of_the_run_is_kept(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet, words: str
) -> None:
    assert words in whole_text(original_record_pdf(noted, tmp_path / "r.pdf", job, "zh"))


def test_each_segment_has_the_time_it_began_at(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet
) -> None:
    names = ["sf_x_before", "sf_x_00", "sf_x_01", "zo_x_1"]
    starts = [
        {"segment": name, "started_utc": f"2026-11-22T08:0{minute}:30.250000+00:00"}
        for minute, name in enumerate(names)
    ]
    timed = replace(noted, notes={**NOTES, "segment_starts": starts})
    printed = lines(original_record_pdf(timed, tmp_path / "r.pdf", job, "zh"))
    start = printed.index("记录次序")
    assert printed[start + 2 : start + 4] == [
        "sf_x_before 2026-11-22 08:00:30 sf_x_01 2026-11-22 08:02:30",
        "sf_x_00 2026-11-22 08:01:30 zo_x_1 2026-11-22 08:03:30",
    ]


def test_the_raw_values_have_the_times_of_their_segments(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet
) -> None:
    x, offset = noted.scale_factor["x"], noted.zero_offset["x"]
    segments = ("sf_x_before", *x.segments, "sf_x_after")
    starts = [
        {"segment": name, "started_utc": f"2026-11-22T08:{minute:02d}:30+00:00"}
        for minute, name in enumerate((*segments, *offset.segments, "ma_x_p", "ma_x_n"))
    ]
    timed = replace(
        noted,
        scale_factor={"x": replace(x, segments=segments)},
        zero_offset={"x": offset},
        notes={**NOTES, "segment_starts": starts},
    )
    printed = lines(original_record_pdf(timed, tmp_path / "r.pdf", job, "zh"))

    def times(title: str, rows: int) -> list[str]:
        start = printed.index(title) + 2
        return [line[-19:] for line in printed[start : start + rows]]

    def expected(first: int, count: int) -> list[str]:
        return [f"2026-11-22 08:{minute:02d}:30" for minute in range(first, first + count)]

    assert times("标度因数记录（7.1），X 轴", 10) == expected(1, 10)
    assert times("表 2  X 轴零偏校准结果记录", 4) == expected(12, 4)
    assert times("表 3  X 轴失准角校准结果记录", 2) == expected(16, 2)
    turned_y = printed.index("表 3  Y 轴失准角校准结果记录")
    assert "2026" not in "".join(printed[turned_y + 2 : turned_y + 4])


def test_without_a_job_the_recording_speaks_for_itself(tmp_path: Path, result: CalibrationResult) -> None:
    text = whole_text(original_record_pdf(result, tmp_path / "r.pdf"))
    assert "0100012345" in text
    assert BUNDLE_SHA256[:16] in text


def test_simulated_records_say_so(tmp_path: Path, result: CalibrationResult) -> None:
    text = whole_text(original_record_pdf(replace(result, simulated=True), tmp_path / "r.pdf"))
    assert "DEMONSTRATION — not a valid record" in text


def test_record_and_plots_stay_inside_their_pages(
    tmp_path: Path, noted: CalibrationResult, job: JobSheet
) -> None:
    for path in (original_record_pdf(noted, tmp_path / "r.pdf", job), plots_pdf(noted, tmp_path / "p.pdf")):
        assert list(outside(spans(path))) == []
        assert list(overlapping(spans(path))) == []


def test_plots_of_a_part_are_drawn_too(tmp_path: Path, result: CalibrationResult) -> None:
    text = whole_text(plots_pdf(replace(result, scale_factor={}, misalignment={}), tmp_path / "p.pdf", "en"))
    assert "Zero-offset positions" in text
    assert "Residuals" not in text


def test_the_multi_position_plot_shows_the_earth_rate(tmp_path: Path, result: CalibrationResult) -> None:
    x = replace(
        result.zero_offset["x"],
        schedule="multi-position",
        angles_deg=(3.8,) * 12,
        azimuths_deg=tuple(30.0 * i for i in range(12)),
        durations_s=(1200.0,) * 12,
        orientations=(),
        earth_rate_check={"amplitude_dps": 11.54 / 3600, "expected_dps": 11.5383 / 3600, "phase_deg": 0.12},
    )
    text = whole_text(plots_pdf(replace(result, zero_offset={"x": x}), tmp_path / "p.pdf", "en"))
    assert "fitted amplitude 11.54 °/h, expected 11.54 °/h; north error 0.120°" in text


@pytest.mark.parametrize("value", [1.0023354972170277, -2.6885030749999997e-4, 3.2e-7, 300.0, 0.0, -1e-300])
def test_figures_keep_ten_digits(value: float) -> None:
    printed = text_of(figure(value)).replace(" × 10", "e")
    assert number_of(printed) == pytest.approx(value, rel=1e-9)


def test_a_column_of_figures_has_one_number_of_decimals() -> None:
    texts = [text_of(one) for one in column_figures([300.7, -0.001, 12.0])]
    assert {len(text.replace("\u2009", "").partition(".")[2]) for text in texts} == {7}
