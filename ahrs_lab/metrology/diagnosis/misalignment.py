"""Diagnosis of L (7.3): what the two senses have in common, and whether they lasted alike."""

from __future__ import annotations

from ahrs_lab.messages import Message
from ahrs_lab.metrology.diagnosis.model import DiagnosisFinding, MisalignmentDiagnosis
from ahrs_lab.metrology.diagnosis.words import figures

_DPH = 3600.0


def diagnose_misalignment(
    angle_positive_deg: float,
    angle_negative_deg: float,
    durations_s: tuple[float, float],
    step_s: float,
) -> MisalignmentDiagnosis:
    """``durations_s`` of the positive and the negative turns, ``step_s`` the sample interval."""
    positive, negative = durations_s
    rest = (angle_positive_deg + angle_negative_deg) / (positive + negative)
    difference = positive - negative
    findings = [
        DiagnosisFinding(
            "fine",
            Message(
                "Turns in the positive sense show {positive}°, in the negative sense {negative}°: half the "
                "difference is the misalignment.",
                positive=figures(angle_positive_deg, 4, plus=True),
                negative=figures(angle_negative_deg, 4, plus=True),
            ),
        ),
        DiagnosisFinding(
            "fine",
            Message(
                "What both senses have in common, {rest} °/h of zero offset and Earth's rate, cancels.",
                rest=figures(_DPH * rest),
            ),
        ),
    ]
    if abs(difference) <= 1.5 * step_s:
        what = Message("Both senses lasted equally long, {duration} s.", duration=f"{positive:.6g}")
        findings.append(DiagnosisFinding("fine", what))
    else:
        what = Message(
            "The senses differ by {difference} s: the zero offset does not cancel by {angle}°, which is in "
            "the uncertainty. Record both equally long.",
            difference=figures(difference, plus=True),
            angle=figures(abs(rest * difference)),
        )
        findings.append(DiagnosisFinding("look", what))
    return MisalignmentDiagnosis(rest, difference, tuple(findings))
