"""What the banner of the page Results says: the verdict with its rule, and what else a reader has to know."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from ahrs_lab.laboratory.judgement import Judged
from ahrs_lab.metrology.conformity import Conformity, Verdict
from ahrs_lab.metrology.limits import measured
from ahrs_lab.ui.pages.words import listed
from ahrs_lab.ui.translation import said
from ahrs_lab.ui.widgets.banner import BannerKind

_KINDS: dict[Verdict, BannerKind] = {
    "pass": "good",
    "conditional pass": "warn",
    "conditional fail": "bad",
    "fail": "bad",
}


def verdict_content(judged: Judged) -> tuple[BannerKind, str, str, str]:
    """Kind, title, text and action of the banner."""
    translate = QCoreApplication.translate
    action = translate("Verdict", "Certificate preview")
    if judged.refusal is not None:
        return "bad", translate("Verdict", "Conformity cannot be stated"), said(judged.refusal), action
    conformity = judged.conformity
    if conformity is None:
        kind: BannerKind = "warn" if judged.shown.warnings else "info"
        counted = translate("Verdict", "Values: {count}").format(count=len(measured(judged.shown)))
        text = "  ·  ".join([counted, *_facts(judged)])
        return kind, translate("Verdict", "Measured; no limits are set"), text, action
    text = "  ·  ".join([*_judgement(conformity), *_facts(judged)])
    if not conformity.within and conformity.verdict in ("pass", "conditional pass"):
        return "bad", translate("Verdict", "Not all that has a limit was calibrated"), text, action
    titles: dict[Verdict, str] = {
        "pass": translate("Verdict", "Pass: all values within their limits"),
        "conditional pass": translate("Verdict", "Conditional pass"),
        "conditional fail": translate("Verdict", "Conditional fail"),
        "fail": translate("Verdict", "Fail: not all values conform"),
    }
    return _KINDS[conformity.verdict], titles[conformity.verdict], text, action


def _judgement(conformity: Conformity) -> list[str]:
    translate = QCoreApplication.translate
    passed = sum(one.verdict == "pass" for one in conformity.statements)
    parts = [
        translate("Verdict", "{passed} of {count} pass").format(
            passed=passed, count=len(conformity.statements)
        ),
        said(conformity.rule.name()),
    ]
    if conformity.missing:
        keys = listed(key.replace("_", "") for key in conformity.missing)
        parts.append(translate("Verdict", "not calibrated: {quantities}").format(quantities=keys))
    return parts


def _facts(judged: Judged) -> list[str]:
    translate, result = QCoreApplication.translate, judged.computed
    method = next((one.uncertainty.method for one in measured(result)), "gum")
    parts = [
        translate("Verdict", "uncertainty by annex A")
        if method == "annex-a"
        else translate("Verdict", "uncertainty by the GUM"),
        translate("Verdict", "deviations from the standard: {count}").format(count=len(result.deviations)),
        translate("Verdict", "warnings: {count}").format(count=len(result.warnings)),
    ]
    if judged.raised:
        count = len(judged.raised)
        parts.append(translate("Verdict", "U raised to the CMC: {count}").format(count=count))
    if result.simulated:
        parts.append(translate("Verdict", "simulated bench"))
    return parts
