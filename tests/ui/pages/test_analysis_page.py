"""The page Analysis on small analyses: choose, fill in, run, read, save; both languages, both themes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QFileDialog, QLabel, QMessageBox, QScrollArea
from pytestqt.exceptions import capture_exceptions
from pytestqt.qtbot import QtBot

from ahrs_lab import messages
from ahrs_lab.analysis.report import Chart, Curve, Report
from ahrs_lab.laboratory.analyses import analyses
from ahrs_lab.laboratory.analyses.kinds import AnalysisKind, Outcome, Setting
from ahrs_lab.messages import Message
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.pages.analysis.page import AnalysisPage
from ahrs_lab.ui.pages.analysis.setting_fields import ChoiceSetting, FlagSetting, NumberSetting, TextSetting
from ahrs_lab.ui.pages.analysis.workbench import Workbench
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.workspace import OpenJob
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.conftest import Look
from tests.ui.pages.fake_laboratory import FakeLaboratory
from tests.ui.pages.small_analyses import CHINESE, COMPARISON, REST, SWING, Gate, rest_bundle

JOB = "2026-0142"


class Scene:
    """The page in its window at 1366×768, with a job open that has a recording."""

    def __init__(
        self, desk: Desk, look: Look, qtbot: QtBot, kinds: tuple[AnalysisKind, ...], home: Path
    ) -> None:
        self.desk, self.look, self.qtbot = desk, look, qtbot
        self.job_recording = rest_bundle(home / "jobs" / JOB / "recording")
        self.window = MainWindow(desk.workspace, theme="light")
        qtbot.addWidget(self.window)
        self.page = AnalysisPage(desk, lambda: kinds)
        self.window.add_page(self.page)
        self.window.resize(1366, 768)
        self.window.show()
        desk.workspace.open_job(OpenJob(JOB, JOB))
        self.notices: list[tuple[str, str]] = []
        desk.workspace.noticed.connect(lambda kind, what: self.notices.append((kind, str(what))))
        self.settle()

    def settle(self) -> None:
        """Until nothing is going on or put off."""
        self.qtbot.waitUntil(self._idle, timeout=20_000)
        self.look.settle()

    def _idle(self) -> bool:
        bench = self.page.workbench
        return not self.desk.background.busy and not (bench is not None and bench._debounce.isActive())

    @property
    def bench(self) -> Workbench:
        assert self.page.workbench is not None
        return self.page.workbench

    def number(self, key: str) -> NumberSetting:
        assert self.bench.form is not None
        field = self.bench.form.fields[key]
        assert isinstance(field, NumberSetting)
        return field

    def type(self, key: str, text: str) -> None:
        """What a person does: all marked, then typed over."""
        line = self.number(key).line
        line.selectAll()
        self.qtbot.keyClicks(line, text)

    def speak(self, language: str) -> None:
        """Switch the screen's language."""
        self.look.language.set_language(language)  # type: ignore[arg-type]
        self.look.settle()

    def run(self) -> None:
        self.qtbot.mouseClick(self.bench.run, Qt.MouseButton.LeftButton)
        self.settle()

    def shown(self) -> list[str]:
        """Every label that can be seen on the page."""
        return [label.text() for label in self.page.findChildren(QLabel) if label.isVisibleTo(self.page)]

    def cells(self) -> list[list[str]]:
        table = self.bench.outcome.report.tables[0].table
        return [table.texts(row) for row in range(len(table.keys()))]


@pytest.fixture
def chinese_words() -> Iterator[None]:
    """The small analyses speak Chinese too."""
    catalogue = messages._catalogue("zh")
    new = {english: text for english, text in CHINESE.items() if english not in catalogue}
    catalogue.update(new)
    yield
    for english in new:
        del catalogue[english]


@pytest.fixture
def scene(desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory, chinese_words: None) -> Scene:
    return Scene(desk, look, qtbot, (REST, COMPARISON, SWING), laboratory.home)


def test_the_list_names_each_analysis_and_what_it_needs(scene: Scene) -> None:
    rows = scene.bench.kinds.rows
    assert [(row.text(), row.needs()) for row in rows.values()] == [
        ("Means at rest", "Recording at rest"),
        ("Comparison", "Reference, unit under test"),
        ("Damped swing", "No recording"),
    ]
    assert rows["rest"].isChecked()


def test_the_open_jobs_recording_is_offered_first_and_the_analysis_runs_on_it(scene: Scene) -> None:
    assert scene.bench.form is not None
    assert scene.bench.form.recordings[0].path() == scene.job_recording
    scene.run()
    assert [row[0] for row in scene.cells()] == ["X", "Y", "Z"]
    assert float(scene.cells()[0][1]) == pytest.approx(0.1, abs=0.002)
    assert scene.cells()[1][1].startswith("−0.2")
    assert scene.cells()[0][4] == "−2.5×10^{−7}"
    assert scene.bench.outcome.warnings.text() == "1 warning"
    assert scene.bench.outcome.report.texts()[0] == "1 gaps: windows across them are left out."
    report = scene.bench.outcome.report
    assert [report.tabs.tabText(i) for i in range(2)] == ["Means over 1 s", "Scatter of the means"]


def test_settings_reach_the_analysis_and_a_change_after_it_is_said(scene: Scene) -> None:
    scene.type("window_s", "2")
    scene.run()
    assert not scene.bench.outcome.stale.isVisibleTo(scene.page)
    assert scene.bench.outcome.report.tabs.tabText(0) == "Means over 2 s"
    assert scene.bench.form is not None
    choice, flag = scene.bench.form.fields["unit"], scene.bench.form.fields["remove_mean"]
    assert isinstance(choice, ChoiceSetting)
    assert isinstance(flag, FlagSetting)
    choice.put("dph")
    scene.qtbot.mouseClick(flag.box, Qt.MouseButton.LeftButton, pos=QPoint(8, flag.box.height() // 2))
    assert scene.bench.outcome.stale.isVisibleTo(scene.page)
    scene.run()
    assert not scene.bench.outcome.stale.isVisibleTo(scene.page)
    # 0.1 °/s were 360 °/h.
    assert abs(float(scene.cells()[0][1].replace("−", "-"))) < 0.1


@pytest.mark.parametrize(
    ("key", "text", "said"),
    [
        ("window_s", "abc", "A number, please."),
        ("window_s", "", "A number, please."),
        ("window_s", "0.01", "From 0.1 to 3600\N{NO-BREAK SPACE}s."),
        ("window_s", "1e9", "From 0.1 to 3600\N{NO-BREAK SPACE}s."),
        ("window_s", "0,5", ""),
        ("period_s", "-2", "At least 0.5\N{NO-BREAK SPACE}s."),
        ("damping", "1.01", "At most 1."),
    ],
)
def test_what_cannot_be_is_said_at_its_field_and_nothing_runs(
    scene: Scene, key: str, text: str, said: str
) -> None:
    if key != "window_s":
        scene.bench.choose("swing")
        scene.settle()
    before = scene.bench.form.outcome if scene.bench.form is not None else None
    if text:
        scene.type(key, text)
    else:
        scene.number(key).line.clear()
    scene.bench.start()
    scene.settle()
    assert scene.number(key).error() == said
    assert scene.bench.form is not None
    assert (scene.bench.form.outcome is before) == bool(said)
    assert scene.number(key).line.text() == text


def test_defaults_come_back_with_a_button(scene: Scene) -> None:
    scene.type("window_s", "-7")
    assert scene.number("window_s").error()
    assert scene.bench.form is not None
    scene.qtbot.mouseClick(scene.bench.form.defaults, Qt.MouseButton.LeftButton)
    assert (scene.number("window_s").line.text(), scene.number("window_s").error()) == ("1", "")


def test_a_table_can_be_copied_into_a_spreadsheet(scene: Scene) -> None:
    scene.run()
    scene.bench.outcome.report.tables[0].copy.click()
    rows = [line.split("\t") for line in scene.look.app.clipboard().text().splitlines()]
    assert [len(row) for row in rows] == [5, 5, 5, 5]
    assert rows[0][0] == "axis"
    assert float(rows[2][1]) == pytest.approx(-0.2, abs=0.01)
    assert float(rows[1][4]) == -2.5e-07


def test_a_missing_recording_is_said_at_its_field(scene: Scene) -> None:
    scene.bench.choose("comparison")
    scene.run()
    assert scene.bench.form is not None
    first, second = scene.bench.form.recordings
    assert (first.field.error(), second.field.error()) == ("", "Choose a recording.")
    second.choose(rest_bundle(scene.job_recording.parent / "other"))
    assert second.field.error() == ""


def test_an_error_is_said_in_the_screens_language_and_nothing_typed_is_lost(scene: Scene) -> None:
    scene.run()
    tables = scene.cells()
    scene.type("window_s", "500")
    scene.run()
    banner = scene.bench.outcome.banner
    assert banner.isVisibleTo(scene.page)
    assert banner.text() == "rest.csv lasts 120 s, but ten windows need 5000 s: choose shorter windows."
    assert scene.number("window_s").line.text() == "500"
    assert scene.cells() == tables
    scene.speak("zh")
    assert banner.text() == "rest.csv 时长 120 s，而十个窗口需要 5000 s：请缩短窗口。"
    scene.bench.choose("swing")
    scene.settle()
    assert not banner.isVisibleTo(scene.page)
    scene.bench.choose("rest")
    assert banner.isVisibleTo(scene.page)
    banner.close_button.click()
    scene.bench.choose("swing")
    scene.bench.choose("rest")
    assert not banner.isVisibleTo(scene.page)


def test_a_recording_that_is_none_is_refused_by_what_reads_it(scene: Scene, tmp_path: Path) -> None:
    assert scene.bench.form is not None
    (tmp_path / "nothing").mkdir()
    scene.bench.form.recordings[0].choose(tmp_path / "nothing")
    scene.run()
    assert "recording.toml" in scene.bench.outcome.banner.text()


def test_the_report_follows_the_language(scene: Scene) -> None:
    scene.run()
    scene.speak("zh")
    report = scene.bench.outcome.report
    assert report.tabs.tabText(1) == "均值的离散度"
    assert report.tables[0].title.text() == "1 s 均值"
    assert report.texts()[0] == "有 1 处缺失：跨越缺失处的窗口未计入。"
    assert scene.bench.kinds.rows["rest"].text() == "静止均值"
    assert scene.bench.outcome.warnings.text() == "1 条警告"
    report.tabs.setCurrentIndex(1)
    assert report.chart is not None
    assert report.chart.legend.texts()[-1] == "白噪声"
    scene.speak("en")
    assert report.chart.legend.texts()[-1] == "white noise"


def test_a_live_analysis_follows_its_settings(scene: Scene) -> None:
    scene.bench.choose("swing")
    scene.settle()
    assert not scene.bench.run.isVisibleTo(scene.page)
    chart = scene.bench.outcome.report.chart
    assert chart is not None
    assert chart.mark_names() == ["period 12 s", "1.1 T", "59.5 s"]
    scene.type("period_s", "20")
    scene.settle()
    assert chart.mark_names()[0] == "period 20 s"
    assert not scene.bench.outcome.stale.isVisibleTo(scene.page)
    scene.type("period_s", "x")
    scene.settle()
    assert scene.number("period_s").error() == "A number, please."
    assert chart.mark_names()[0] == "period 20 s"


def test_each_analysis_stays_as_it_was_left(scene: Scene) -> None:
    scene.type("window_s", "3")
    scene.run()
    scene.bench.choose("swing")
    scene.settle()
    assert scene.bench.outcome.report.tabs.count() == 1
    scene.bench.choose("rest")
    assert scene.number("window_s").line.text() == "3"
    assert scene.bench.outcome.report.tabs.tabText(0) == "Means over 3 s"


def test_another_job_offers_its_recording(scene: Scene, laboratory: FakeLaboratory) -> None:
    other = rest_bundle(laboratory.home / "jobs" / "2026-0200" / "recording")
    scene.desk.workspace.open_job(OpenJob("2026-0200", "2026-0200"))
    assert scene.bench.form is not None
    assert scene.bench.form.recordings[0].path() == other
    scene.desk.workspace.open_job(None)
    assert scene.bench.form.recordings[0].path() is None


def test_recordings_can_be_dropped(scene: Scene, tmp_path: Path) -> None:
    scene.bench.choose("comparison")
    archive = tmp_path / "unit.ahrsrec"
    archive.write_bytes(b"")
    folder = rest_bundle(tmp_path / "reference")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in (folder / "recording.toml", archive)])
    copy, left = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton
    enter = QDragEnterEvent(QPoint(5, 5), copy, data, left, Qt.KeyboardModifier.NoModifier)
    scene.bench.dragEnterEvent(enter)
    assert enter.isAccepted()
    scene.bench.dropEvent(QDropEvent(QPoint(5, 5), copy, data, left, Qt.KeyboardModifier.NoModifier))
    assert scene.bench.form is not None
    # The empty field is filled before the one that has the job's.
    assert [recording.path() for recording in scene.bench.form.recordings] == [archive, folder]


def test_what_is_dropped_and_no_recording_is_told(scene: Scene, tmp_path: Path) -> None:
    notices: list[str] = []
    scene.desk.workspace.noticed.connect(lambda _kind, what: notices.append(str(what)))
    before = scene.bench.form.recordings[0].path() if scene.bench.form else None
    (tmp_path / "holiday").mkdir()
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / "holiday"))])
    copy, left = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton
    enter = QDragEnterEvent(QPoint(5, 5), copy, data, left, Qt.KeyboardModifier.NoModifier)
    scene.bench.dragEnterEvent(enter)
    assert enter.isAccepted()
    scene.bench.dropEvent(QDropEvent(QPoint(5, 5), copy, data, left, Qt.KeyboardModifier.NoModifier))
    assert ["No recording: holiday." in notice for notice in notices] == [True]
    assert scene.bench.form is not None
    assert scene.bench.form.recordings[0].path() == before


def test_files_are_looked_for_with_dialogs(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = rest_bundle(tmp_path / "found")
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(folder))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(folder / "recording.toml"), ""))
    form = scene.bench.form
    assert form is not None
    form.recordings[0].find_folder()
    assert form.recordings[0].path() == folder
    form.recordings[0].find_file()
    assert form.recordings[0].path() == folder
    field = form.fields["set"]
    assert isinstance(field, TextSetting)
    assert field.seek is not None
    field.seek.click()
    assert field.read() == str(folder / "recording.toml")


def test_the_outcome_is_saved_and_files_are_not_replaced_unasked(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene.run()
    target = tmp_path / "out"
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(target))
    scene.bench.outcome.save.click()
    scene.settle()
    assert sorted(path.name for path in target.iterdir()) == ["plots.pdf", "result.json", "series.csv"]
    assert scene.notices[-1][0] == "good"
    assert "plots.pdf" in scene.notices[-1][1]
    before = (target / "result.json").read_bytes()
    (target / "result.json").write_bytes(b"mine")
    asked: list[str] = []

    def refuse(box: QMessageBox) -> int:
        asked.append(box.text())
        return 0

    monkeypatch.setattr(QMessageBox, "exec", refuse)
    scene.bench.outcome.save.click()
    scene.settle()
    assert asked == ["The folder holds already: result.json, series.csv, plots.pdf."]
    assert (target / "result.json").read_bytes() == b"mine"
    monkeypatch.setattr(
        QMessageBox, "clickedButton", lambda box: next(b for b in box.buttons() if b.text() == "Replace")
    )
    scene.bench.outcome.save.click()
    scene.settle()
    assert (target / "result.json").read_bytes() == before


def test_a_saved_recording_is_never_written_into(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcome = Outcome({"new": True}, Report(Message("Mean rates")), saves={"corrected": Path.mkdir})
    kind = replace(REST, run=lambda _bundles, _settings: outcome)
    scene = Scene(desk, look, qtbot, (kind,), laboratory.home)
    scene.run()
    target = laboratory.home / "out"
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(target))
    scene.bench.outcome.save.click()
    scene.settle()
    (target / "corrected" / "recording.toml").write_text("", encoding="utf-8")
    (target / "result.json").write_bytes(b"mine")
    scene.bench.outcome.save.click()
    scene.settle()
    assert "corrected" in scene.notices[-1][1]
    assert (target / "result.json").read_bytes() == b"mine"


def test_a_number_that_is_not_stated_is_an_empty_field(look: Look, qtbot: QtBot) -> None:
    field = NumberSetting(Setting("u", Message("uncertainty"), "number", -1.0, "°", 0.0, 10.0, blank=-1.0))
    qtbot.addWidget(field)
    field.retranslate()
    assert field.line.text() == ""
    assert field.read() == -1.0
    assert field.error() == ""
    qtbot.keyClicks(field.line, "-1")
    assert field.read() is None
    assert "From 0" in field.error()
    field.line.clear()
    assert field.read() == -1.0
    assert field.error() == ""


def test_long_work_shows_that_it_goes_on_and_the_screen_stays_alive(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    gate = Gate()
    scene = Scene(desk, look, qtbot, (gate.kind(), REST), laboratory.home)
    try:
        qtbot.mouseClick(scene.bench.run, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(gate.started.is_set)
        assert not scene.bench.run.isEnabled()
        assert not scene.bench.outcome.progress_shown()
        qtbot.waitUntil(scene.bench.outcome.progress_shown)
        scene.bench.choose("rest")
        assert not scene.bench.outcome.progress_shown()
        assert scene.bench.run.isEnabled()
    finally:
        gate.open.set()
    scene.settle()
    # Its outcome waits where it belongs.
    assert scene.bench.form is not None
    assert scene.bench.form.outcome is None
    scene.bench.choose("gate")
    assert scene.bench.outcome.report.chart is not None
    assert scene.bench.run.isEnabled()


def test_a_defect_does_not_leave_the_page_waiting(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    gate = Gate()
    gate.defect = True
    gate.open.set()
    scene = Scene(desk, look, qtbot, (gate.kind(),), laboratory.home)
    with capture_exceptions() as caught:
        scene.run()
    assert [kind for kind, _, _ in caught] == [ZeroDivisionError]
    assert scene.bench.run.isEnabled()


def test_a_live_analysis_that_is_slow_ends_with_the_last_settings(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    gate = Gate()
    kind = replace(SWING, run=gate.run)
    scene = Scene(desk, look, qtbot, (REST, kind), laboratory.home)
    try:
        scene.bench.choose("swing")
        qtbot.waitUntil(gate.started.is_set)
        for text in ("20", "30", "40"):
            scene.type("period_s", text)
        qtbot.wait(300)
        assert gate.asked == [12.0]
    finally:
        gate.open.set()
    scene.settle()
    assert gate.asked == [12.0, 40.0]
    chart = scene.bench.outcome.report.chart
    assert chart is not None
    assert chart.mark_names()[0] == "period 40 s"


def test_the_page_brings_no_plots_and_no_systems_before_it_is_entered() -> None:
    """The first window does not wait for them."""
    code = (
        "import sys; import ahrs_lab.ui.pages.analysis.page; "
        "print([name for name in ('pyqtgraph', 'scipy', 'reportlab', 'ahrs_lab.laboratory.analyses') "
        "if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("language", ["en", "zh"])
def test_nothing_is_cut_and_no_button_out_of_reach(scene: Scene, language: str) -> None:
    if language == "zh":
        scene.speak("zh")
    faults = {}
    for key in ("rest", "comparison", "swing"):
        scene.bench.choose(key)
        scene.settle()
        for state in ("empty", "run", "error"):
            if key == "rest":
                scene.type("window_s", "500" if state == "error" else "1")
            if state != "empty":
                scene.run()
            scene.look.settle()
            found = clipped_texts(scene.page) + [f"outside: {text}" for text in outside(scene.window)]
            if found:
                faults[key, state] = found
    assert faults == {}


def test_the_chinese_page_has_no_english_words(scene: Scene) -> None:
    scene.speak("zh")
    for key in ("rest", "comparison", "swing"):
        scene.bench.choose(key)
        scene.run()
        texts = [text for text in scene.shown() if "/" not in text]
        allowed = {"1 s 均值", "s"}
        assert [t for t in texts if any(c.isascii() and c.isalpha() for c in t) and t not in allowed] == [], (
            key
        )


def test_both_themes_paint_the_chart(scene: Scene) -> None:
    scene.run()
    chart = scene.bench.outcome.report.chart
    assert chart is not None
    corner = {}
    for mode in ("light", "dark"):
        scene.look.theme.set_mode(mode)
        scene.look.settle()
        picture = chart.grab().toImage()
        corner[mode] = picture.pixelColor(picture.width() - 3, 3).lightness()
    assert corner["light"] > 200
    assert corner["dark"] < 60


def test_long_names_and_many_charts_find_room(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    long = Message("a name that says at some length what is meant by it and (in brackets) what is not")
    settings = tuple(
        Setting(kind, long, kind, default, choices=(("a", long),))  # type: ignore[arg-type]
        for kind, default in (("number", 1.0), ("choice", "a"), ("flag", True), ("text", ""), ("file", ""))
    )
    t_s = np.arange(3.0)
    titles = [Message("Chart {n} of a rather long row", n=n) for n in range(6)]
    charts = tuple(Chart(title, long, long, (Curve("X", t_s, t_s),)) for title in titles)
    outcome = Outcome({}, Report(long, charts=charts))
    kind = AnalysisKind("long", long, long, (long,), settings, lambda _b, _s: outcome)
    scene = Scene(desk, look, qtbot, (kind,), laboratory.home)
    scene.run()
    report = scene.bench.outcome.report
    assert not report.tabs.isVisibleTo(scene.page)
    assert report.charts.combo.count() == 6
    report.charts.combo.setCurrentIndex(4)
    report.charts.combo.activated.emit(4)
    assert report.tabs.currentIndex() == 4
    look.settle()
    assert clipped_texts(scene.page) == []
    form = scene.bench.form
    assert form is not None
    area = form.findChild(QScrollArea)
    assert area is not None
    inside = area.widget()
    assert inside is not None
    assert inside.width() <= area.viewport().width()
    scene.window.resize(2400, 900)
    look.settle()
    assert report.tabs.isVisibleTo(scene.page)


def test_an_empty_house_says_what_will_be_here(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    scene = Scene(desk, look, qtbot, (), laboratory.home)
    assert scene.page.workbench is None
    assert "Analyses of recordings" in scene.shown()
    assert clipped_texts(scene.page) == []


def test_every_analysis_of_the_house_has_its_place(
    desk: Desk, look: Look, qtbot: QtBot, laboratory: FakeLaboratory
) -> None:
    kinds = analyses()
    scene = Scene(desk, look, qtbot, kinds, laboratory.home)
    assert len({kind.key for kind in kinds}) == len(kinds)
    for language in ("en", "zh"):
        scene.speak(language)
        for kind in kinds:
            scene.bench.choose(kind.key)
            scene.settle()
            assert clipped_texts(scene.page) == [], kind.key
            assert scene.bench.form is not None
            assert {key: field.read() for key, field in scene.bench.form.fields.items()} == kind.defaults()
