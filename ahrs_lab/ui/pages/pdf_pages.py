"""Pages of a PDF as pictures, drawn in the worker. PDFium is not thread-safe: one drawing at a time."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtGui import QImage

from ahrs_lab.errors import MachineError

_ONE_AT_A_TIME = threading.Lock()
MOST_PAGES = 200


@dataclass(frozen=True)
class PdfPicture:
    """All pages of one file, drawn ``scale`` pixels a point."""

    file: Path
    scale: float
    pages: tuple[QImage, ...]


def draw_pages(file: Path, scale: float) -> PdfPicture:
    """Draw every page; raises MachineError where the file cannot be read as a PDF.

    The file is read whole at once, so that a signature can be added meanwhile.
    """
    import pypdfium2

    try:
        content = file.read_bytes()
    except OSError as error:
        raise MachineError(
            "{path} cannot be shown: {reason}.", path=file.name, reason=error.strerror or str(error)
        ) from error
    with _ONE_AT_A_TIME:
        try:
            document = pypdfium2.PdfDocument(content)
        except pypdfium2.PdfiumError as error:
            raise MachineError(
                "{path} cannot be shown: {reason}.", path=file.name, reason=str(error)
            ) from error
        try:
            document.init_forms()  # draws the signatures' stamps
            count = min(len(document), MOST_PAGES)
            return PdfPicture(file, scale, tuple(_draw(document, number, scale) for number in range(count)))
        finally:
            document.close()


def _draw(document: object, number: int, scale: float) -> QImage:
    page = document[number]  # type: ignore[index]
    bitmap = page.render(scale=scale, may_draw_forms=True, rev_byteorder=True, prefer_bgrx=True)
    image = QImage(
        bitmap.buffer, bitmap.width, bitmap.height, bitmap.stride, QImage.Format.Format_RGBX8888
    ).copy()
    bitmap.close()
    page.close()
    return image
