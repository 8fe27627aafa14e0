"""The operator's day at the screen: a whole accelerated calibration by what can be seen and pressed, from the
start page to the certificate that three people signed; and what goes wrong on the way.

Nothing is done behind the screen's back but waiting, reading, hurrying the bench's clock, and playing fate on
the virtual bench (a wrong mounting, a tripped drive).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox

from ahrs_lab.cli import main
from ahrs_lab.errors import InputError
from ahrs_lab.laboratory.laboratory import Laboratory
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.rounding import format_grouped, round_to_uncertainty
from ahrs_lab.procedures.events import MountRequested
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.recording.segment import Segment
from ahrs_lab.simulation.bench import world_of
from ahrs_lab.simulation.truth import truth
from ahrs_lab.simulation.world import World
from ahrs_lab.ui.application import Screen
from ahrs_lab.ui.pages.certificate import CertificatePage
from ahrs_lab.ui.theme import tokens
from tests.ui.clipped_text import clipped_texts, outside
from tests.ui.conftest import Look
from tests.ui.operator_words import BOTH_SCRIPTS, EN, NAMES, STOP, ZH, Words
from tests.ui.playing import Hands, pass_time

JOB = "2026-0001"
PASSWORD = "demo"
HURRY = 100.0
"""Bench seconds per second: slow enough to see what the table does, fast enough to wait for it."""
SLOW = 4.0
SEGMENTS = 45
"""Of the accelerated plan: per axis 7 rates, 2 rests, 2 turns and 4 positions."""


@dataclass
class Stage:
    """The window on a demonstration laboratory, the hands before it, and the bench behind it."""

    laboratory: Laboratory
    screen: Screen
    hands: Hands
    words: Words

    @property
    def world(self) -> World:
        """The virtual bench of the run."""
        run = self.screen.workspace.run.run
        assert run is not None
        return world_of(run.bench)

    @property
    def request(self) -> MountRequested | None:
        """The mounting that is asked for, once the screen has taken it over."""
        return self.screen.workspace.run.model.request

    @property
    def state(self) -> str:
        """The run's."""
        return self.screen.workspace.run.model.state

    def segments(self) -> tuple[Segment, ...]:
        """All takes in the job's recording."""
        try:
            recording = read_bundle(self.laboratory.bundle(JOB))
        except InputError:
            # What read_bundle says of a recording without a segment.
            return ()
        return tuple(recorded.segment for recorded in recording.segments)

    def look_around(self, name: str, *names: str) -> None:
        """What has to hold on every page: one language (but for ``names``), no text cut, no button out of the
        window."""
        self.hands.picture(name)
        assert self.hands.foreign(self.words.language, self.words.known.union(names)) == []
        # A text that has just grown gets its room with the next layout.
        cut: list[str] = []
        for _ in range(5):
            cut = clipped_texts(self.screen.window)
            if not cut:
                break
            pass_time(0.05)
        assert cut == []
        assert outside(self.screen.window) == []

    def settle(self) -> None:
        """Until the pages' worker has nothing to do."""
        self.hands.until(lambda: not self.screen.desk.background.busy, "the pages to be ready")

    # what the operator does ─────────────────────────────────────────────────────────────────────────────

    def begin(self) -> None:
        """From the start page to the first mounting."""
        self.hands.press(self.words.prepare, beside=JOB)
        self.hands.press(self.words.begin)
        self.wait_for_mounting()

    def wait_for_mounting(self, before: MountRequested | None = None) -> None:
        """Until another mounting is asked for, or the run is over."""
        self.hands.until(
            lambda: (
                (self.request is not None and self.request is not before)
                or not self.screen.workspace.run.live
            ),
            "the next mounting",
        )

    def confirm(self, *, by_key: bool = False) -> None:
        """Say "mounted" by the button or the space bar, and wait until the run has taken it."""
        asked = self.request
        assert asked is not None
        if by_key:
            self.hands.key(Qt.Key.Key_Space)
        else:
            self.hands.press(self.words.mounted)
        self.hands.until(lambda: self.request is not asked, "the run to go on")

    def mount_all(self) -> int:
        """All mountings that are asked for, by button and key in turn; how many there were."""
        count = 0
        while self.request is not None:
            self.confirm(by_key=count % 2 == 1)
            count += 1
            self.wait_for_mounting()
        return count

    def sign(self, button: str, name: str) -> None:
        """Press it and give the password."""

        def answer() -> None:
            self.hands.picture("sign")
            self.hands.type_into(self.words.password_of.format(name=name), PASSWORD)
            self.hands.press(self.words.sign)

        self.hands.in_dialog(lambda: self.hands.press(button), answer)
        self.settle()

    def change_person(self, name: str) -> None:
        """The person whose turn it is signs in."""

        def answer() -> None:
            self.hands.picture("sign-in")
            assert self.hands.sees(name)
            self.hands.type_into(self.words.password, PASSWORD)
            self.hands.press(self.words.sign_in)

        self.hands.in_dialog(lambda: self.hands.press(self.words.sign_in_as), answer)
        assert self.hands.sees(name)


@pytest.fixture
def stage(look: Look, isolated_home: Path) -> Iterator[Callable[..., Stage]]:
    """Opens the application on a new demonstration laboratory at 1366×768."""
    opened: list[Stage] = []

    def open_stage(words: Words, pictures: str) -> Stage:
        isolated_home.mkdir()
        laboratory = Laboratory(isolated_home)
        laboratory.prepare_demo()
        screen = Screen(look.app, laboratory, language=words.language, speed=None, demo=True)
        screen.window.resize(1366, 768)
        screen.window.show()
        screen.window.activateWindow()
        made = Stage(laboratory, screen, Hands(screen.window, pictures), words)
        opened.append(made)
        made.hands.until(screen.window.isActiveWindow, "the window to come up")
        assert (screen.window.width(), screen.window.height()) == (1366, 768)
        return made

    yield open_stage
    for made in opened:
        made.screen.close()
        made.screen.language.set_language("en")
        for switch in (made.screen.language, made.screen.theme):
            switch.deleteLater()
        made.screen.window.close()
        made.screen.window.deleteLater()
        made.screen.workspace.deleteLater()
        made.laboratory.close()


# ── the day ─────────────────────────────────────────────────────────────────────────────────────────────────


@pytest.mark.parametrize("words", [EN, ZH], ids=["en", "zh"])
def test_a_whole_day_from_the_job_to_the_verified_certificate(
    stage: Callable[..., Stage], words: Words, capsys: pytest.CaptureFixture[str]
) -> None:
    day: Stage = stage(words, f"day-{words.language}-")
    hands = day.hands
    day.look_around("start")
    hands.press(words.prepare, beside=JOB)
    day.look_around("job", *BOTH_SCRIPTS)
    hands.press(words.begin)
    day.wait_for_mounting()
    asked = measure_and_read(day)
    assert asked == ["x+", "y+", "z+", "x-", "z-", "y-"]
    read_results(day)
    certificate = sign_by_three(day)
    assert main(["verify", str(certificate), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [signature["role"] for signature in report["signatures"]] == ["operator", "verifier", "approver"]
    hands.press(words.start)
    assert hands.sees(words.issued)
    day.look_around("end")


def measure_and_read(day: Stage) -> list[str]:
    """Each mounting: the instruction is read, then confirmed. In the middle language and theme are switched
    there and back. Returns the faces that were asked for."""
    hands = day.hands
    faces: list[str] = []
    while day.request is not None:
        request = day.request
        read_instruction(day, request)
        if len(faces) in (0, 3):
            day.look_around(f"mount-{len(faces) + 1}")
        if len(faces) == 2:
            switch_language_and_theme(day, request)
        day.confirm(by_key=len(faces) % 2 == 1)
        faces.append(request.orientation.face)
        day.wait_for_mounting(request)
        assert day.world.orientation == request.orientation
    hands.wait_for(day.words.certificate)
    return faces


def read_instruction(day: Stage, request: MountRequested) -> None:
    """The asked axis is named, and of each axis where it has to point."""
    asked = request.orientation
    sentence = day.words.mount_up if asked.up_sign > 0 else day.words.mount_down
    hands = day.hands
    hands.wait_for(sentence.format(axis=asked.up_axis.upper()))
    texts = hands.texts(day.screen.window.pages["run"])
    for axis, letter in zip("XYZ", asked.letters, strict=True):
        assert texts[texts.index(axis) + 1] == day.words.directions[letter]


def switch_language_and_theme(day: Stage, request: MountRequested) -> None:
    """To the other language and the dark theme, and back; the same instruction stands there in each."""
    hands, own = day.hands, day.words
    day.words = EN if own.language == "zh" else ZH
    hands.press(own.other_language)
    read_instruction(day, request)
    hands.choose_in_menu(lambda: hands.press(day.words.theme), day.words.dark)
    assert tokens().dark
    day.look_around("switched")
    hands.choose_in_menu(lambda: hands.press(day.words.theme), day.words.light)
    hands.press(day.words.other_language)
    day.words = own
    read_instruction(day, request)
    assert day.laboratory.settings.language == own.language


def read_results(day: Stage) -> None:
    """Each number on the screen is the result's, rounded by its uncertainty, and the result is the truth."""
    hands = day.hands
    day.settle()
    day.look_around("results")
    result = day.laboratory.result(JOB)
    assert isinstance(result, CalibrationResult)
    shown = hands.texts(day.screen.window.pages["results"])
    for name, value, expanded in numbers_of(result):
        pair = round_to_uncertainty(value, expanded)
        line = f"{name} {format_grouped(pair.value)} ± {format_grouped(pair.expanded)}"
        assert any(text == line or text.startswith(f"{line}, ") for text in shown), line
    near_the_truth(day, result)
    hands.turn_to(day.words.values)
    day.look_around("values")
    for number in ("Kx", "By", "Lyz"):
        assert hands.sees(number)
    hands.turn_to(day.words.findings)
    for deviation in result.deviations:
        assert hands.sees(deviation.text(day.words.language))
    day.look_around("findings")
    hands.press(day.words.certificate)


def numbers_of(result: CalibrationResult) -> Iterator[tuple[str, float, float]]:
    """Symbol, value and U of each quantity in the units that the cards begin with: 1, °/h, arc minutes."""
    for axis, scale in result.scale_factor.items():
        yield f"K{axis}", scale.K, scale.uncertainty.expanded
    for axis, offset in result.zero_offset.items():
        yield f"B{axis}", 3600.0 * offset.B, 3600.0 * offset.uncertainty.expanded
    for pair, angle in result.misalignment.items():
        minutes = 60.0 * 57.29577951308232
        yield f"L{pair}", minutes * angle.L, minutes * angle.uncertainty.expanded


def near_the_truth(day: Stage, result: CalibrationResult) -> None:
    """What was measured by clicking is what the virtual unit is, within twice the stated U."""
    run = day.screen.workspace.run.run
    assert run is not None
    known = truth(run.bench)
    rates = tuple(rate for rate in run.plan.scale_factor.rates_dps)
    for axis, K in zip("xyz", known.fitted_scale_factor(rates), strict=True):
        found = result.scale_factor[axis]  # type: ignore[index]
        assert abs(found.K - K) < 2.0 * found.uncertainty.expanded
    for pair, L in known.L.items():
        angle = result.misalignment[pair]
        assert abs(angle.L - L) < 2.0 * angle.uncertainty.expanded


def sign_by_three(day: Stage) -> Path:
    """Preview, then the three signatures, each by its own person; returns the signed file."""
    hands, words = day.hands, day.words
    operator, verifier, approver = NAMES[words.language]
    hands.wait_for(words.preview)
    day.settle()
    page = day.screen.window.pages["certificate"]
    assert isinstance(page, CertificatePage)
    assert page.view.count() >= 3
    day.look_around("preview")
    day.sign(words.sign_operator, operator)
    assert not hands.has_button(words.sign_verifier)
    day.change_person(verifier)
    day.sign(words.sign_verifier, verifier)
    day.look_around("two-signatures")
    day.change_person(approver)
    day.sign(words.sign_approver, approver)
    assert not hands.has_button(words.sign_approver)
    hands.press(words.verify_again)
    day.settle()
    hands.wait_for(words.intact)
    assert hands.texts().count(words.signed) == 3
    for name in (operator, verifier, approver):
        assert hands.sees(name)
    day.look_around("signed")
    certificate = day.laboratory.certificate(JOB)
    assert certificate is not None
    return certificate


# ── what goes wrong ─────────────────────────────────────────────────────────────────────────────────────────


def spinning(day: Stage) -> None:
    """Mount the first face, and wait until a rate is being recorded: the table turns."""
    day.world.clock.speed = HURRY
    day.confirm()
    day.hands.until(lambda: recording_a_rate(day), "a rate to be recorded")
    day.world.clock.speed = SLOW


def recording_a_rate(day: Stage) -> bool:
    """The screen shows a recording with the table turning, and it turns."""
    shown = day.screen.workspace.run.model.segment
    return shown is not None and shown.segment.role == "rate" and abs(day.world.table.state().rate_dps) > 20.0


def finish(day: Stage) -> None:
    """The rest of the run as fast as it goes, up to its result."""
    day.world.clock.speed = None
    day.wait_for_mounting()
    day.mount_all()
    day.hands.wait_for(day.words.certificate)
    assert day.laboratory.job(JOB).state == "measured"


def test_esc_in_mid_spin_stops_the_bench_and_the_run_goes_on_where_it_was(
    stage: Callable[..., Stage],
) -> None:
    day: Stage = stage(EN, "stop-")
    hands, words = day.hands, day.words
    day.begin()
    spinning(day)
    day.look_around("spinning")
    hands.key(Qt.Key.Key_Escape)
    hands.wait_for(words.stopped)
    assert not day.world.table.state().moving
    assert not day.world.supply.read().output_on
    assert hands.sees(words.stopped_why)
    assert hands.sees(words.at_rest)
    day.look_around("stopped")
    assert day.laboratory.job(JOB).state == "ready"
    kept = {segment.file: segment for segment in day.segments() if not segment.interrupted}
    assert "sf_x_before" in {segment.name for segment in kept.values()}
    written = {name: (day.laboratory.bundle(JOB) / name).stat().st_mtime_ns for name in kept}
    hands.press(words.resume)
    day.wait_for_mounting()
    assert day.laboratory.job(JOB).state == "running"
    assert hands.sees(words.mount_up.format(axis="X"))
    day.look_around("resumed")
    finish(day)
    after = {segment.file: segment for segment in day.segments()}
    assert {name: after[name] for name in kept} == kept
    assert {name: (day.laboratory.bundle(JOB) / name).stat().st_mtime_ns for name in kept} == written
    counted = [s.name for s in after.values() if not s.interrupted and not s.superseded]
    assert len(counted) == len(set(counted)) == SEGMENTS
    hands.press(words.run)
    assert hands.sees(words.done)
    day.look_around("complete")


@pytest.mark.parametrize("words", [EN, ZH], ids=["en", "zh"])
def test_a_wrong_mounting_is_refused_with_what_the_sensor_feels_and_asked_again(
    stage: Callable[..., Stage], words: Words
) -> None:
    day: Stage = stage(words, f"wrong-{words.language}-")
    hands = day.hands
    day.begin()
    first = day.request
    assert first is not None
    day.world.faults.trigger("wrong_mounting", once=True)
    hands.press(words.mounted)
    day.wait_for_mounting(first)
    assert day.request is not None
    assert day.request.orientation == first.orientation
    read_instruction(day, day.request)
    hands.wait_for(words.refused[0])
    refusal = next(text for text in hands.texts() if text.startswith(words.refused[0]))
    assert all(part in refusal for part in words.refused)
    assert day.segments() == ()
    day.look_around("refused")
    day.confirm(by_key=True)
    day.wait_for_mounting()
    assert day.request.orientation.face == "y+"
    assert {segment.orientation.face for segment in day.segments()} == {"x+"}
    hands.press(STOP[words.language])
    hands.wait_for(words.stopped)


def test_a_tripped_drive_is_told_with_what_to_do(stage: Callable[..., Stage]) -> None:
    day: Stage = stage(ZH, "trip-")
    hands, words = day.hands, day.words
    day.begin()
    spinning(day)
    day.world.faults.trigger("table_trips", above_dps=20.0)
    hands.wait_for(words.failed)
    told = "\n".join(hands.texts())
    assert all(part in told for part in words.fault_told)
    assert not day.world.table.state().moving
    assert not day.world.supply.read().output_on
    hands.picture("tripped")
    assert any(segment.interrupted for segment in day.segments())
    hands.press(words.resume)
    finish(day)
    hands.press(STOP[words.language])
    assert hands.sees(words.nothing_to_stop)


def test_pause_and_a_repeated_segment_with_its_reason(stage: Callable[..., Stage]) -> None:
    day: Stage = stage(ZH, "pause-")
    hands, words = day.hands, day.words
    day.begin()
    spinning(day)
    hands.key(Qt.Key.Key_P)
    hands.wait_for(words.pausing)
    day.world.clock.speed = HURRY
    hands.wait_for(words.paused)
    assert hands.sees(words.pause_told)
    assert not day.world.table.state().moving
    assert day.world.supply.read().output_on
    day.look_around("paused")
    hands.press(words.go_on)
    finish(day)
    before = {segment.file: segment for segment in day.segments()}
    hands.press(words.run)
    repeat_a_segment(day)
    takes = [s for s in day.segments() if s.name == "zo_z_1"]
    assert [take.superseded for take in takes] == [True, False]
    assert takes[1].reason == words.typed_reason
    assert takes[0].file in before
    assert len(day.segments()) == len(before) + 1
    rows = day.laboratory.records.jobs.results(JOB)
    assert len(rows) == 2
    assert rows[0].sha256 != rows[1].sha256


def repeat_a_segment(day: Stage) -> None:
    """By the run page's dialog, which asks for the reason; one mounting belongs to it."""
    hands, words = day.hands, day.words

    def answer() -> None:
        assert not hands.has_button(words.record_again)
        combo = hands.front.findChild(QComboBox)
        assert combo is not None
        hands.choose(combo, words.segment)
        hands.type_into(words.reason, words.typed_reason)
        hands.picture("repeat")
        hands.press(words.record_again)

    hands.in_dialog(lambda: hands.press(words.repeat), answer)
    day.wait_for_mounting()
    day.look_around("repeat-mounting")
    assert words.repeated_step in hands.texts()
    steps = day.screen.workspace.run.model.groups
    assert [(group.mounting, [line.step.kind for line in group.lines]) for group in steps] == [
        ("y+", ["mount", "power", "position"])
    ]
    assert day.mount_all() == 1
    hands.wait_for(words.certificate)
    day.settle()


def test_nobody_repeats_what_is_signed_or_belongs_to_somebody_else(stage: Callable[..., Stage]) -> None:
    day: Stage = stage(EN, "signed-")
    hands, words = day.hands, day.words
    day.begin()
    day.mount_all()
    hands.wait_for(words.certificate)
    hands.press(words.certificate)
    day.settle()
    day.sign(words.sign_operator, NAMES["en"][0])
    day.change_person(NAMES["en"][1])
    hands.press(words.run)
    before = day.segments()

    def answer() -> None:
        hands.type_into(words.reason, words.typed_reason)
        hands.press(words.record_again)

    hands.in_dialog(lambda: hands.press(words.repeat), answer)
    hands.wait_for("takes the role")
    hands.picture("refused")
    assert not day.screen.workspace.run.live
    assert day.segments() == before
    assert day.laboratory.job(JOB).state == "measured"
    assert [signature.role for signature in day.laboratory.signatures(JOB)] == ["operator"]
