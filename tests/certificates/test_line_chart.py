"""Charts of curves on paper: what they say can be read, what has no place is left out."""

from __future__ import annotations

from pathlib import Path

import pytest

from ahrs_lab.certificates.documents import Block, Heading, Label, Line, LineChart, same
from ahrs_lab.certificates.drawing import AXIS_COLOURS
from ahrs_lab.certificates.line_chart import LineChartBox, looks
from ahrs_lab.certificates.report_pdf import report_pdf
from tests.certificates.pdf_text import whole_text

NAN = float("nan")


def written(tmp_path: Path, *blocks: Block) -> str:
    target = report_pdf(
        Label(same("报告").main, same("Report").main),
        blocks,
        tmp_path / "a.pdf",
        source="unit",
        software="x 1",
    )
    return whole_text(target)


def chart(*lines: Line, **more: object) -> LineChart:
    return LineChart(lines, same("time, s"), same("angle, °"), **more)  # type: ignore[arg-type]


def test_axes_legend_and_marks_stand_on_the_page(tmp_path: Path) -> None:
    lines = (
        Line(same("first"), ((0.0, 1.0), (10.0, 3.0)), axis="x"),
        Line(same("second"), ((0.0, 2.0), (10.0, NAN)), (1.0, NAN), (2.5, NAN), style="dashed"),
    )
    marks = ((5.0, same("five")), (99.0, same("far")))
    text = written(tmp_path, Heading(same("A chart"), level=2), chart(*lines, marks=marks))
    for words in (
        "报告",
        "Report",
        "unit",
        "A chart",
        "first",
        "second",
        "time, s",
        "angle, °",
        "five",
        "10",
        "2.5",
    ):
        assert words in text
    assert "far" not in text
    assert "x 1" in text


def test_logarithmic_axes_leave_out_what_is_not_above_zero(tmp_path: Path) -> None:
    line = Line(
        same("a"),
        ((0.0, 1.0), (0.1, 10.0), (10.0, -1.0), (100.0, 1000.0)),
        (0.5, 5.0, -2.0, 500.0),
        (2.0,) * 4,
    )
    text = written(tmp_path, chart(line, log_x=True, log_y=True))
    assert "0.1" in text
    assert "1000" in text


@pytest.mark.parametrize("points", [(), ((1.0, NAN),), ((1.0, 0.0),), ((2.0, 5.0), (2.0, 5.0))])
def test_a_curve_without_extent_is_drawn_all_the_same(
    tmp_path: Path, points: tuple[tuple[float, float], ...]
) -> None:
    assert "lonely" in written(tmp_path, chart(Line(same("lonely"), points)))
    assert "lonely" in written(tmp_path, chart(Line(same("lonely"), points), log_x=True, log_y=True))


def test_a_track_is_drawn_to_one_scale(tmp_path: Path) -> None:
    track = Line(same("track"), ((0.0, 0.0), (100.0, 1.0)))
    # 100 m across the page: its height then spans about 25 m, not one.
    assert "−10" in written(tmp_path, chart(track, equal=True))
    assert "−10" not in written(tmp_path, chart(track))


def test_a_long_legend_takes_more_lines_and_height() -> None:
    few = chart(Line(same("a"), ((0.0, 1.0),)))
    many = chart(*(Line(same(f"curve number {i}"), ((0.0, 1.0),)) for i in range(12)))
    assert LineChartBox(many).height(480.0) > LineChartBox(few).height(480.0) + 20.0


def test_axes_have_their_colour_and_a_model_its_own_dash() -> None:
    measured, model, other, another = looks(
        [
            Line(same("y"), (), axis="y"),
            Line(same("model"), (), axis="y", style="dashed"),
            Line(same("other"), ()),
            Line(same("another"), (), style="dashed"),
        ]
    )
    assert measured[0] == model[0] == AXIS_COLOURS["y"]
    assert measured[1] != model[1]
    assert len({measured[0], other[0], another[0]}) == 3
    assert not other[1]
    assert another[1]
