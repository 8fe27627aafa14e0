"""Reports as a terminal shows them."""

from __future__ import annotations

from ahrs_lab.analysis.report import Report, Table, report_text
from ahrs_lab.messages import Message


def test_columns_are_measured_from_their_content() -> None:
    table = Table(Message("Bias"), ("", "value"), (("x", "1.25"), ("long name", "−12.5")))
    text = report_text(Report(Message("Title"), (table,), warnings=(Message("odd"),)))
    assert text.splitlines() == [
        "Title",
        "",
        "Bias",
        "             value",
        "  x           1.25",
        "  long name  −12.5",
        "  warning: odd",
    ]
