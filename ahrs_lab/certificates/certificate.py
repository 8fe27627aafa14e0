"""The certificate as a PDF, ready to be signed."""

from __future__ import annotations

from pathlib import Path

from ahrs_lab.certificates.content import certificate_content
from ahrs_lab.certificates.imu_sheet import imu_sheet
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet
from ahrs_lab.certificates.layout import write_document
from ahrs_lab.metrology.imu_result import ImuResult
from ahrs_lab.metrology.result import CalibrationResult


def certificate_pdf(
    result: CalibrationResult | ImuResult,
    job: JobSheet,
    target: Path,
    language: CertificateLanguage = "bilingual",
) -> Path:
    """Write the unsigned certificate to ``target``, of an IMU its result sheet; the same bytes for the same
    result, job and language.

    Raises:
        InputError: the result does not belong to the job, or a character cannot be printed.
        MachineError: the file cannot be written.
    """
    if isinstance(result, ImuResult):
        return write_document(imu_sheet(result, job, language), target)
    return write_document(certificate_content(result, job, language), target)
