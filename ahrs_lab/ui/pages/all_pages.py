"""All pages, in the order of the rail, each made and its libraries imported when it is first needed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ahrs_lab.ui.page import Page, PageEntry
from ahrs_lab.ui.pages.start import StartPage

if TYPE_CHECKING:
    from ahrs_lab.ui.pages.desk import Desk


def page_entries(desk: Desk) -> tuple[PageEntry, ...]:
    """Start first: it is what the window opens with."""

    def run() -> Page:
        from ahrs_lab.ui.run.page import RunPage

        return RunPage(desk.workspace, desk.resume_run, desk.repeat_segment)

    def jobs() -> Page:
        from ahrs_lab.ui.pages.jobs.page import JobsPage

        return JobsPage(desk)

    def results() -> Page:
        from ahrs_lab.ui.pages.results.page import ResultsPage

        return ResultsPage(desk)

    def certificate() -> Page:
        from ahrs_lab.ui.pages.certificate import CertificatePage

        return CertificatePage(desk)

    def analyse() -> Page:
        from ahrs_lab.ui.pages.analysis.page import AnalysisPage

        return AnalysisPage(desk)

    def bench() -> Page:
        from ahrs_lab.ui.pages.bench import BenchPage

        return BenchPage(desk)

    def instruments() -> Page:
        from ahrs_lab.ui.pages.instruments.page import InstrumentsPage

        return InstrumentsPage(desk)

    def setup() -> Page:
        from ahrs_lab.ui.pages.setup import SetupPage

        return SetupPage(desk)

    return (
        PageEntry("start", lambda: StartPage(desk)),
        PageEntry("jobs", jobs),
        PageEntry("run", run),
        PageEntry("results", results),
        PageEntry("certificate", certificate),
        PageEntry("analyse", analyse),
        PageEntry("bench", bench),
        PageEntry("instruments", instruments),
        PageEntry("setup", setup),
    )
