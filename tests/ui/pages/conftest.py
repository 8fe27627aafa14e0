"""Pages in their window, on a laboratory that pretends."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from ahrs_lab.records import people
from ahrs_lab.records.rows import SignedIn
from ahrs_lab.ui.main_window import MainWindow
from ahrs_lab.ui.pages.all_pages import page_entries
from ahrs_lab.ui.pages.bench import BenchPage
from ahrs_lab.ui.pages.certificate import CertificatePage
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs.page import JobsPage
from ahrs_lab.ui.pages.results.page import ResultsPage
from ahrs_lab.ui.pages.setup import SetupPage
from ahrs_lab.ui.pages.start import StartPage
from ahrs_lab.ui.workspace import Workspace
from tests.ui.conftest import Look
from tests.ui.pages.fake_laboratory import PASSWORD, FakeLaboratory, fill


@dataclass
class Screens:
    """The window and its pages, by their own types."""

    window: MainWindow
    desk: Desk
    laboratory: FakeLaboratory
    look: Look
    start: StartPage
    jobs: JobsPage
    results: ResultsPage
    certificate: CertificatePage
    bench: BenchPage
    setup: SetupPage
    notices: list[tuple[str, str]]

    def settle(self, qtbot: QtBot) -> None:
        """Until the worker has nothing to do and Qt has nothing put off."""
        qtbot.waitUntil(lambda: not self.desk.background.busy, timeout=20_000)
        self.look.settle()

    def number(self, state: str) -> str:
        """Of the job in this state."""
        return next(job.number for job in self.laboratory.jobs() if job.state == state)


@pytest.fixture(scope="module", autouse=True)
def cheap_passwords() -> Iterator[None]:
    """Hashing is slow by design; here it is only in the way."""
    from argon2 import PasswordHasher

    with pytest.MonkeyPatch.context() as patch:
        cheap = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
        patch.setattr(people, "_hasher", lambda: cheap)
        yield


@pytest.fixture
def look(one_look: Look) -> Iterator[Look]:
    """Light and English; what a test switches is switched back (and nothing styled anew where it did not)."""
    yield one_look
    if one_look.theme.mode != "light":
        one_look.theme.set_mode("light")
    one_look.language.set_language("en")


@pytest.fixture(scope="session")
def filled_home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Records with a job in each state, made once and copied for each test."""
    home = tmp_path_factory.mktemp("filled")
    laboratory = FakeLaboratory(home)
    fill(laboratory)
    laboratory.close()
    return home


@pytest.fixture
def laboratory(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[FakeLaboratory]:
    """Empty records, or the filled ones where the test asks for ``screens`` or ``actors``."""
    if {"screens", "actors"} & set(request.fixturenames):
        filled: Path = request.getfixturevalue("filled_home")
        shutil.copytree(filled, tmp_path, dirs_exist_ok=True)
    made = FakeLaboratory(tmp_path)
    yield made
    made.close()


@pytest.fixture
def desk(look: Look, qtbot: QtBot, laboratory: FakeLaboratory) -> Iterator[Desk]:
    """A desk on the laboratory; nobody is signed in."""
    workspace = Workspace(laboratory, laboratory.settings, speed=None)
    made = Desk(workspace, workspace)
    yield made
    made.close()
    workspace.run.close(0.0)
    workspace.deleteLater()


@pytest.fixture
def actors(laboratory: FakeLaboratory, desk: Desk) -> dict[str, SignedIn]:
    """A job in each state; the operator is signed in."""
    found = {
        role: laboratory.sign_in(next(p.name for p in laboratory.people() if role in p.roles), PASSWORD)
        for role in ("operator", "verifier", "approver")
    }
    desk.sign_in(found["operator"])
    return found


SHOWN = ("start", "jobs", "results", "certificate", "bench", "setup")


@pytest.fixture
def empty_screens(look: Look, qtbot: QtBot, desk: Desk, laboratory: FakeLaboratory) -> Screens:
    """All pages at 1366×768 before there is anything."""
    window = MainWindow(desk.workspace, theme="light")
    qtbot.addWidget(window)
    for entry in page_entries(desk):
        if entry.key in SHOWN:
            window.add_entry(entry)
    window.make_all_pages()
    start, jobs, results, certificate, bench, setup = (window.pages[key] for key in SHOWN)
    assert isinstance(start, StartPage)
    assert isinstance(jobs, JobsPage)
    assert isinstance(results, ResultsPage)
    assert isinstance(certificate, CertificatePage)
    assert isinstance(bench, BenchPage)
    assert isinstance(setup, SetupPage)
    window.resize(1366, 768)
    window.show()
    notices: list[tuple[str, str]] = []
    desk.workspace.noticed.connect(lambda kind, what: notices.append((kind, str(what))))
    look.settle()
    return Screens(window, desk, laboratory, look, start, jobs, results, certificate, bench, setup, notices)


@pytest.fixture
def screens(empty_screens: Screens, actors: dict[str, SignedIn]) -> Screens:
    """All pages with a job in each state, the operator signed in."""
    empty_screens.start.refresh()
    return empty_screens


@pytest.fixture
def chinese(look: Look) -> Iterator[Callable[[], None]]:
    """Call it to switch the screen to Chinese."""

    def switch() -> None:
        look.language.set_language("zh")
        look.settle()

    yield switch
    look.language.set_language("en")
