"""Lays a document out on A4 and writes it as PDF: fonts embedded, the same bytes for the same contents.

The three signature fields are already in the file, empty, so that signing only ever adds to it.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import Document, SignatureBox, label, texts_of
from ahrs_lab.certificates.drawing import GREY, RULE, Pen, wrap
from ahrs_lab.certificates.fonts import REGULAR, check_glyphs, register_fonts
from ahrs_lab.certificates.pages import (
    BOTTOM,
    MARGIN,
    PAGE_HEIGHT,
    PAGE_WIDTH,
    WIDTH,
    FrameDrawing,
    Page,
    boxes_of,
    draw_page,
    flow,
)
from ahrs_lab.certificates.richtext import bold, grey, joined
from ahrs_lab.errors import InputError, MachineError

if TYPE_CHECKING:
    from reportlab.lib.utils import ImageReader

Role = Literal["operator", "verifier", "approver"]
Rectangle = tuple[float, float, float, float]

_TITLE_SIZE = 25.0
_BOX_GAP = 12.0
_BOX_HEIGHT = 86.0
_LABEL_HEIGHT = 22.0
_SEAL = 84.0
_SIGNATURES = _BOX_HEIGHT + _SEAL + 18.0
_LARGEST_SEAL = 4000
"""Pixels."""


@dataclass(frozen=True)
class SignaturePlace:
    """Where a signature's appearance goes: page from 0, left, bottom, right, top in points."""

    role: Role
    page: int
    box: Rectangle


def write_document(document: Document, target: Path) -> Path:
    """Lay out, finish and write ``document``.

    Raises:
        InputError: a character that cannot be printed; a seal that is no image.
        MachineError: the file cannot be written.
    """
    from ahrs_lab.certificates.finishing import finished

    pdf, places = laid_out(document)
    data = finished(pdf, places, document.frame)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data)
    except OSError as error:
        raise MachineError(
            "{path} cannot be written ({reason}): choose another folder or make room",
            path=target,
            reason=error.strerror or error,
        ) from error
    return target


def laid_out(document: Document) -> tuple[bytes, tuple[SignaturePlace, ...]]:
    """The pages as reportlab writes them, and where the signatures go."""
    from reportlab import rl_config
    from reportlab.pdfgen.canvas import Canvas

    rl_config.useA85 = 0  # streams as bytes: text around them would only make the file larger
    register_fonts()
    check_glyphs(texts_of(document))
    frame = FrameDrawing(document.frame)
    front, signature_page = _front(document, frame)
    top = frame.content_top(first=False)
    pages = list(front)
    for group in document.pages:
        pages += flow(boxes_of(group), top, top, BOTTOM)
    buffer = io.BytesIO()
    canvas = Canvas(
        buffer,
        pagesize=(PAGE_WIDTH, PAGE_HEIGHT),
        invariant=1,
        pageCompression=1,
        initialFontName=REGULAR,  # type: ignore[arg-type] # the stub says float
    )
    pen = Pen(canvas)
    places: tuple[SignaturePlace, ...] = ()
    for index, page in enumerate(pages):
        frame.draw(pen, index + 1, len(pages))
        if index == 0:
            _title(pen, document, frame)
        draw_page(pen, page)
        if document.signatures and index == signature_page:
            places = _signatures(pen, document, index)
        canvas.showPage()
    canvas.save()
    return buffer.getvalue(), places


def _title_height(document: Document) -> float:
    lines = len(wrap(bold(document.frame.title.main), _TITLE_SIZE, WIDTH))
    return lines * _TITLE_SIZE * 1.25 + (18.0 if document.frame.title.second else 0.0) + 20.0


def _title(pen: Pen, document: Document, frame: FrameDrawing) -> None:
    y = frame.content_top(first=True) - _TITLE_SIZE
    title = document.frame.title
    for line in wrap(bold(title.main), _TITLE_SIZE, WIDTH):
        pen.text(PAGE_WIDTH / 2, y, line, _TITLE_SIZE, align="centre", air=0.08 * _TITLE_SIZE)
        y -= _TITLE_SIZE * 1.25
    if title.second:
        pen.text(PAGE_WIDTH / 2, y + 8.0, title.second, 11.0, ink=GREY, align="centre")


def _front(document: Document, frame: FrameDrawing) -> tuple[list[Page], int]:
    """The front, on one page with the signatures where it fits; else the signatures follow at its end."""
    boxes = boxes_of(document.front)
    first_top = frame.content_top(first=True) - _title_height(document)
    top = frame.content_top(first=False)
    reserved = _SIGNATURES + 10.0 if document.signatures else 0.0
    pages = flow(boxes, first_top, top, BOTTOM + reserved)
    if len(pages) == 1 or not document.signatures:
        return pages, len(pages) - 1
    pages = flow(boxes, first_top, top, BOTTOM)
    if pages[-1].room_below < reserved:
        pages.append(Page())
    return pages, len(pages) - 1


def _signatures(pen: Pen, document: Document, page: int) -> tuple[SignaturePlace, ...]:
    """Three boxes at the foot of the page, the seal above the last."""
    count = len(document.signatures)
    wide = (WIDTH - _BOX_GAP * (count - 1)) / count
    bottom = BOTTOM + 8.0
    _seal(pen, document, PAGE_WIDTH - MARGIN - wide / 2 - _SEAL / 2, bottom + _BOX_HEIGHT + 6.0)
    places = []
    for index, box in enumerate(document.signatures):
        left = MARGIN + index * (wide + _BOX_GAP)
        pen.box(left, bottom, wide, _BOX_HEIGHT, edge=RULE, radius=6.0)
        _signature_label(pen, box, left, bottom)
        inside = (left + 6.0, bottom + 5.0, left + wide - 6.0, bottom + _BOX_HEIGHT - _LABEL_HEIGHT)
        places.append(SignaturePlace(box.role, page, inside))
    return tuple(places)


def _signature_label(pen: Pen, box: SignatureBox, left: float, bottom: float) -> None:
    name = joined(bold(box.label.main), "   " if box.label.second else "", grey(box.label.second))
    pen.text(left + 10.0, bottom + _BOX_HEIGHT - 16.0, name, 9.0)


def _seal(pen: Pen, document: Document, x: float, y: float) -> None:
    """Clause 8 d): the image, or the place where the stamp goes."""
    if document.seal is None:
        pen.canvas.setDash([3, 3])
        pen.canvas.setStrokeColorRGB(*RULE)
        pen.canvas.circle(x + _SEAL / 2, y + _SEAL / 2, _SEAL / 2 - 2.0, stroke=1, fill=0)
        pen.canvas.setDash([])
        name = label(wording.SEAL, document.frame.language)
        pen.text(x + _SEAL / 2, y + _SEAL / 2, name.main, 8.0, ink=GREY, align="centre")
        pen.text(x + _SEAL / 2, y + _SEAL / 2 - 10.0, name.second, 7.0, ink=GREY, align="centre")
        return
    pen.canvas.drawImage(seal_image(document.seal), x, y, _SEAL, _SEAL, mask="auto", preserveAspectRatio=True)


def seal_image(path: Path) -> ImageReader:
    """The seal as reportlab draws it; refuses what is no reasonable image."""
    from PIL import Image, UnidentifiedImageError
    from reportlab.lib.utils import ImageReader

    try:
        with Image.open(path, formats=("PNG",)) as image:
            if max(image.size) > _LARGEST_SEAL:
                raise InputError(
                    "The seal {path} is too large ({width} × {height} pixels); at most {limit} each way",
                    path=path,
                    width=image.size[0],
                    height=image.size[1],
                    limit=_LARGEST_SEAL,
                )
            return ImageReader(image.convert("RGBA"))
    except (OSError, UnidentifiedImageError, SyntaxError, ValueError) as error:
        raise InputError("The seal {path} is not a PNG image that can be read", path=path) from error
