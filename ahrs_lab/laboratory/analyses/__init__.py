"""The analyses that the house offers, in the order of the textbook: one module each, its ``KIND`` is listed
here."""

from __future__ import annotations

from ahrs_lab.laboratory.analyses.kinds import AnalysisKind


def analyses() -> tuple[AnalysisKind, ...]:
    """All of them; imported when asked for."""
    from ahrs_lab.laboratory.analyses import (
        alignment,
        allan,
        compensation,
        error_propagation,
        imu_calibration,
        installation,
        navigation,
        transfer_alignment,
    )

    return (
        allan.KIND,
        imu_calibration.KIND,
        compensation.KIND,
        navigation.KIND,
        error_propagation.KIND,
        alignment.KIND,
        transfer_alignment.KIND,
        installation.CALIBRATE,
        installation.COMPENSATE,
    )
