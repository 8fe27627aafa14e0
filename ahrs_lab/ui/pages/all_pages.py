"""All pages but the run, made on one desk, in the order of the rail."""

from __future__ import annotations

from ahrs_lab.ui.page import Page
from ahrs_lab.ui.pages.bench import BenchPage
from ahrs_lab.ui.pages.certificate import CertificatePage
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.page import JobsPage
from ahrs_lab.ui.pages.results.page import ResultsPage
from ahrs_lab.ui.pages.setup import SetupPage
from ahrs_lab.ui.pages.start import StartPage


def make_pages(desk: Desk) -> tuple[Page, ...]:
    """Start, jobs, results, certificate, bench, set-up; the run's page belongs behind the second."""
    start, jobs = StartPage(desk), JobsPage(desk)

    def new_job() -> None:
        desk.workspace.go_to(jobs.key)
        jobs.new_job()

    start.new_job.connect(new_job)
    return (start, jobs, ResultsPage(desk), CertificatePage(desk), BenchPage(desk), SetupPage(desk))
