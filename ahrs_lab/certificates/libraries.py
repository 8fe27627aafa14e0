"""The libraries behind documents and signatures, for who has time to load them before they are needed."""

from __future__ import annotations

from ahrs_lab.certificates.fonts import register_fonts
from ahrs_lab.messages import Message


def load_layout() -> None:
    """What laying a document out takes, with the Chinese texts."""
    import pikepdf  # noqa: F401
    import reportlab.pdfgen.canvas  # noqa: F401

    register_fonts()
    Message("operator").text("zh")


def load_signing() -> None:
    """What signing and verifying take."""
    import pyhanko.pdf_utils.incremental_writer
    import pyhanko.sign.validation
    import pyhanko.stamp  # noqa: F401
