"""Words for what the records keep as keys: states, roles, kinds; in the language that is on."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QCoreApplication

from ahrs_lab.metrology.conformity import RuleKind, Verdict
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.records.rows import JobState, Role
from ahrs_lab.ui.pages.widgets.chip import ChipKind


def listed(names: Iterable[str]) -> str:
    """One after the other, as the language separates them."""
    return QCoreApplication.translate("Words", ", ").join(names)


def role_names() -> dict[Role, str]:
    """Who may do what; operator first."""
    translate = QCoreApplication.translate
    return {
        "operator": translate("Words", "Operator"),
        "verifier": translate("Words", "Verifier"),
        "approver": translate("Words", "Approver"),
        "administrator": translate("Words", "Administrator"),
    }


def state_names() -> dict[JobState, str]:
    """How far a job is."""
    translate = QCoreApplication.translate
    return {
        "draft": translate("Words", "Draft"),
        "ready": translate("Words", "Ready"),
        "running": translate("Words", "Running"),
        "measured": translate("Words", "Measured"),
        "checked": translate("Words", "Checked"),
        "issued": translate("Words", "Issued"),
    }


STATE_LOOKS: dict[JobState, tuple[ChipKind, str]] = {
    "draft": ("plain", "edit"),
    "ready": ("accent", "run"),
    "running": ("accent", "record"),
    "measured": ("warn", "results"),
    "checked": ("warn", "verify"),
    "issued": ("good", "good"),
}
"""Tint and icon of each state."""


def standard_kinds() -> dict[str, str]:
    """What a measurement standard is."""
    translate = QCoreApplication.translate
    return {
        "table": translate("Words", "Single-axis position and rate table"),
        "supply": translate("Words", "DC power supply"),
        "fixture": translate("Words", "Mounting fixture"),
        "room": translate("Words", "Thermometer and hygrometer"),
        "north": translate("Words", "North reference"),
        "other": translate("Words", "Other"),
    }


def axis_names() -> dict[Axis, str]:
    """The angle an axis of the case is tied to."""
    translate = QCoreApplication.translate
    return {
        "x": translate("Words", "heading"),
        "y": translate("Words", "pitch"),
        "z": translate("Words", "roll"),
    }


def instrument_name(identity: str) -> str:
    """What a virtual instrument says of itself; of any other what it says."""
    name, mark, rest = identity.partition(" (simulated)")
    if not mark or rest:
        return identity
    translate = QCoreApplication.translate
    known = {
        "single-axis position and rate table": translate("Words", "single-axis position and rate table"),
        "DC supply": translate("Words", "DC supply"),
    }
    return translate("Words", "{name} (simulated)").format(name=known.get(name, name))


def verdict_names() -> dict[Verdict, str]:
    """What is said of a value against its limit; the best first."""
    translate = QCoreApplication.translate
    return {
        "pass": translate("Words", "Pass"),
        "conditional pass": translate("Words", "Conditional pass"),
        "conditional fail": translate("Words", "Conditional fail"),
        "fail": translate("Words", "Fail"),
    }


def short_verdict_names() -> dict[Verdict, str]:
    """The same where there is little room."""
    translate = QCoreApplication.translate
    return verdict_names() | {
        "conditional pass": translate("Words", "Cond. pass"),
        "conditional fail": translate("Words", "Cond. fail"),
    }


def rule_names() -> dict[RuleKind, str]:
    """Decision rules, as they are chosen."""
    translate = QCoreApplication.translate
    return {
        "simple": translate("Words", "Simple acceptance"),
        "guard-band": translate("Words", "Guard band w = r·U"),
        "non-binary": translate("Words", "Non-binary, guard band w = r·U"),
    }


def fault_names() -> dict[str, str]:
    """Faults of the virtual bench, in plain words."""
    translate = QCoreApplication.translate
    return {
        "table_trips": translate("Words", "The table's drive trips and brakes"),
        "table_never_settles": translate("Words", "The table's rate never settles"),
        "table_ignores_commands": translate("Words", "The table ignores commands"),
        "table_runs_away": translate("Words", "The table does not stop"),
        "supply_never_settles": translate("Words", "The supply current never settles"),
        "ahrs_silent": translate("Words", "The device goes silent"),
        "ahrs_dropouts": translate("Words", "One sample in ten is lost"),
        "wrong_mounting": translate("Words", "The case is mounted wrongly"),
        "wrong_rate": translate("Words", "A table set by hand turns the wrong way"),
        "room_out_of_limits": translate("Words", "The room is at 26 °C and 90 %RH"),
    }
