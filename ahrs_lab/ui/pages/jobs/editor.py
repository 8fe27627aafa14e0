"""One job: order, standards, plan, bench, beside what still stands before its run."""

from __future__ import annotations

from datetime import date

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget

from ahrs_lab.errors import AhrsLabError
from ahrs_lab.records.rows import CustomerRow, DeviceRow, JobDraft, JobRow, SignedIn
from ahrs_lab.ui.page import Translated
from ahrs_lab.ui.pages.desk import Desk
from ahrs_lab.ui.pages.jobs import checks
from ahrs_lab.ui.pages.jobs.before_run import BeforeRunCard, Readiness
from ahrs_lab.ui.pages.jobs.bench_form import BenchForm
from ahrs_lab.ui.pages.jobs.limits_form import LimitsForm
from ahrs_lab.ui.pages.jobs.order_form import SIGNERS, OrderForm
from ahrs_lab.ui.pages.jobs.plan_form import PlanForm
from ahrs_lab.ui.pages.jobs.reason_dialog import ReasonDialog
from ahrs_lab.ui.pages.jobs.standards_form import StandardsForm
from ahrs_lab.ui.pages.widgets.chip import Chip
from ahrs_lab.ui.pages.widgets.tabs import Tabs
from ahrs_lab.ui.pages.words import STATE_LOOKS, state_names
from ahrs_lab.ui.theme import CARD_MARGIN, GAP
from ahrs_lab.ui.widgets import Card, IconButton, Label, PrimaryButton, SecondaryButton

_JUDGE_MS = 150
STANDARD_PLAN = "standard"
_PLANNED = ("draft", "ready")
"""States in which plan and bench can still be changed."""
STARTABLE = ("draft", "ready", "running", "measured")


class JobEditor(Translated):
    """``left`` asks for the list again."""

    left = Signal()

    def __init__(self, desk: Desk) -> None:
        super().__init__()
        self._desk = desk
        self._job: JobRow | None = None
        self._dirty = False
        self._judge_soon = QTimer(self)
        self._judge_soon.setSingleShot(True)
        self._judge_soon.setInterval(_JUDGE_MS)
        self._judge_soon.timeout.connect(self._judge)
        self.order, self.limits, self.standards = OrderForm(), LimitsForm(), StandardsForm()
        self.plan, self.bench = PlanForm(), BenchForm()
        self._forms = (self.order, self.limits, self.standards, self.plan, self.bench)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(CARD_MARGIN)
        column.addLayout(self._make_head())
        body = QHBoxLayout()
        body.setSpacing(CARD_MARGIN)
        body.addWidget(self._make_forms(), 7)
        self.before_run = BeforeRunCard()
        body.addWidget(self.before_run, 3)
        column.addLayout(body, 1)
        for form in self._forms:
            form.edited.connect(self._edited)
        self.standards.edit_standards.connect(lambda: self._desk.workspace.go_to("setup"))
        self.retranslate()

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(GAP)
        self.back = IconButton("back")
        self.back.clicked.connect(self.left)
        self._title = Label(role="title")
        self._chip = Chip()
        self.save_button = SecondaryButton()
        self.save_button.clicked.connect(self.save)
        self.start_button = PrimaryButton(icon="run")
        self.start_button.clicked.connect(self.start)
        row.addWidget(self.back)
        row.addWidget(self._title)
        row.addWidget(self._chip, 0, Qt.AlignmentFlag.AlignVCenter)
        row.addStretch(1)
        row.addWidget(self.save_button)
        row.addWidget(self.start_button)
        return row

    def _make_forms(self) -> Card:
        card = Card()
        self.tabs = Tabs()
        self._stack = QStackedWidget()
        for form in self._forms:
            area = QScrollArea()
            area.setWidgetResizable(True)
            area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            inside = QWidget()
            inside.setObjectName("scrolled")
            layout = QVBoxLayout(inside)
            layout.setContentsMargins(0, 0, GAP, 0)
            layout.addWidget(form)
            area.setWidget(inside)
            self._stack.addWidget(area)
        self.tabs.currentChanged.connect(self._stack.setCurrentIndex)
        card.add(self.tabs)
        card.add(self._stack, 1)
        return card

    # content --------------------------------------------------------------------------------------------

    def new(self) -> None:
        """An empty job with the standard plan, on the first bench, signed by whoever alone can."""
        laboratory = self._desk.laboratory
        plans, benches = laboratory.plan_presets(), laboratory.bench_presets()
        people = [person for person in laboratory.people() if person.active]
        chosen: list[int] = []
        for role in SIGNERS:
            able = [p.id for p in people if role in p.roles and p.id not in chosen]
            chosen.append(able[0] if len(able) == 1 else 0)
        self._job = None
        self._show(
            JobDraft(
                customer=CustomerRow(0, ""),
                device=DeviceRow(0, ""),
                received=date.today(),  # noqa: DTZ011  the laboratory's own day
                plan_toml=plans.get(STANDARD_PLAN, ""),
                bench_toml=next(iter(benches.values()), ""),
                standard_ids=tuple(row.id for row in laboratory.standards()),
                operator_id=chosen[0],
                verifier_id=chosen[1],
                approver_id=chosen[2],
            )
        )
        self.tabs.setCurrentIndex(0)
        self.order.customer.line.setFocus()

    def edit(self, job: JobRow) -> None:
        """Show a job of the records; what was typed and not saved for the same job stays."""
        if self._dirty and self._job is not None and self._job.number == job.number:
            return
        self._job = job
        self._show(draft_of(job))

    def number(self) -> str:
        """Of the job shown, "" for a new one."""
        return self._job.number if self._job is not None else ""

    def draft(self) -> JobDraft:
        """What stands in the forms."""
        order = self.order.order()
        # What was run is not written anew by a form that would write it otherwise.
        run = self._job if self._job is not None and self._job.state not in _PLANNED else None
        return JobDraft(
            customer=order.customer,
            device=order.device,
            received=order.received,
            place=order.place,
            place_en=order.place_en,
            plan_toml=run.plan_toml if run else self.plan.plan_text(),
            bench_toml=run.bench_toml if run else self.bench.bench_text(),
            standard_ids=self.standards.chosen(),
            operator_id=order.people[0],
            verifier_id=order.people[1],
            approver_id=order.people[2],
            limits_json=self.limits.text(),
        )

    def _show(self, draft: JobDraft) -> None:
        laboratory = self._desk.laboratory
        self.order.set_known(laboratory.records.registry.customers(), laboratory.people())
        self.order.set_order(draft)
        self.limits.set_text(draft.limits_json)
        self.standards.set_standards(laboratory.standards(), draft.standard_ids)
        self.plan.set_presets(laboratory.plan_presets())
        self.plan.set_text(draft.plan_toml)
        self.bench.set_presets(laboratory.bench_presets())
        self.bench.set_text(draft.bench_toml)
        self._dirty = False
        self._permit()
        self._judge()

    def _permit(self) -> None:
        state = self._job.state if self._job is not None else "draft"
        signed = self._job is not None and bool(self._desk.laboratory.signatures(self._job.number))
        open_order = state in ("draft", "ready", "measured") and not signed
        self.order.set_editable(open_order)
        self.limits.set_editable(open_order)
        self.standards.set_editable(open_order)
        self.plan.set_editable(state in _PLANNED)
        self.bench.set_editable(state in _PLANNED)
        self._chip.setVisible(self._job is not None)
        if self._job is not None:
            kind, icon = STATE_LOOKS[self._job.state]
            self._chip.set_content(kind, icon, state_names()[self._job.state])
        self._title.setText(
            self.tr("Job {number}").format(number=self._job.number) if self._job else self.tr("New job")
        )
        self.start_button.setVisible(state in STARTABLE and not signed)
        self.start_button.setText(
            self.tr("Measure again") if state == "measured" else self.tr("Start calibration")
        )
        self.save_button.setVisible(open_order)
        self.save_button.setEnabled(self._dirty or self._job is None)

    def _edited(self) -> None:
        self._dirty = True
        self.save_button.setEnabled(True)
        self._judge_soon.start()

    def _judge(self) -> None:
        self.plan.set_limits(self.bench.limits)
        draft = self.draft()
        found = self.plan.view()
        limits = self.bench.limits
        runnable = found.runnable and found.plan is not None
        by_standard = found.plan is None or found.plan.procedure == "jjf1536-2015"
        readiness = Readiness(
            missing=checks.missing(draft),
            violations=checks.clause6(
                draft, self._desk.laboratory.profile(), self._desk.laboratory.standards()
            ),
            plan_ok=runnable,
            deviations=found.deviations if runnable else (),
            estimate=(
                checks.estimate(found.plan, limits)
                if runnable and found.plan and limits is not None
                else None
            ),
            limits=self.limits.refusal(),
            by_standard=by_standard,
            limits_unused=bool(self.limits.lines) and not by_standard,
        )
        self.before_run.show_readiness(readiness)
        self.start_button.setEnabled(readiness.limits is None)

    # actions --------------------------------------------------------------------------------------------

    def save(self) -> bool:
        """Into the records; False where it was refused (and said so)."""
        actor = self._desk.ask_actor(self)
        return actor is not None and self._save(actor)

    def _save(self, actor: SignedIn) -> bool:
        laboratory = self._desk.laboratory
        wrong = self.limits.refusal()
        if wrong is not None:
            # The form says it already, where it can be mended.
            self.tabs.setCurrentIndex(self._forms.index(self.limits))
            return False
        try:
            if self._job is None:
                number = laboratory.create_job(self.draft(), actor)
            else:
                number = self._job.number
                laboratory.update_job(number, self.draft(), actor)
            self._job = laboratory.job(number)
        except AhrsLabError as error:
            self._desk.tell(error)
            return False
        self._dirty = False
        self._show(draft_of(self._job))
        self._desk.open(number)
        self._desk.changed()
        return True

    def start(self) -> None:
        """Save what was typed, ask for a second person's reason where clause 6 wants one, and start."""
        actor = self._desk.ask_actor(self)
        if (
            actor is None
            or ((self._dirty or self._job is None) and not self._save(actor))
            or self._job is None
        ):
            return
        number = self._job.number
        missing = checks.missing(self.draft())
        if missing or not self.plan.view().runnable:
            self._desk.workspace.notice(
                "warn", self.tr("The job is not complete yet: see the list “Before the run” on its page.")
            )
            return
        violations = self._desk.laboratory.clause6(number)
        reason, second = "", None
        if violations:
            dialog = ReasonDialog(self._desk, actor, violations, self)
            accepted = bool(dialog.exec())
            reason, second = dialog.reason_text(), dialog.second
            dialog.deleteLater()
            if not accepted:
                return
        self._desk.open(number)
        self._desk.start_run(number, actor, reason, second)

    def retranslate(self) -> None:
        self.back.set_hint(self.tr("All jobs"))
        self.tabs.set_texts(
            self.tr("Order"), self.tr("Limits"), self.tr("Standards"), self.tr("Plan"), self.tr("Bench")
        )
        self.save_button.setText(self.tr("Save"))
        self.before_run.retranslate()
        self._permit()


def draft_of(job: JobRow) -> JobDraft:
    """A job's facts as they can be edited."""
    return JobDraft(
        customer=job.customer,
        device=job.device,
        received=job.received,
        place=job.place,
        place_en=job.place_en,
        plan_toml=job.plan_toml,
        bench_toml=job.bench_toml,
        standard_ids=tuple(row.id for row in job.standards),
        operator_id=job.operator.id if job.operator else 0,
        verifier_id=job.verifier.id if job.verifier else 0,
        approver_id=job.approver.id if job.approver else 0,
        limits_json=job.limits_json,
    )
