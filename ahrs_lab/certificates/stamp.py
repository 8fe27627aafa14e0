"""What a signature looks like on the page: name in both scripts, position, date."""

from __future__ import annotations

import io
from datetime import date

from ahrs_lab.certificates import wording
from ahrs_lab.certificates.boxes import one_line
from ahrs_lab.certificates.documents import both, label
from ahrs_lab.certificates.drawing import ACCENT, GREY, INK, Pen, text_width, wrap
from ahrs_lab.certificates.fonts import REGULAR, check_glyphs, register_fonts
from ahrs_lab.certificates.job_sheet import CertificateLanguage, Person
from ahrs_lab.certificates.richtext import RichText, bold, plain

_WHITE = (1.0, 1.0, 1.0)


def stamp_pdf(
    person: Person, signed: date, size: tuple[float, float], language: CertificateLanguage = "bilingual"
) -> bytes:
    """One page of ``size`` points with the person's name, position and the date; covers what is below it."""
    from reportlab.pdfgen.canvas import Canvas

    register_fonts()
    name = both(person.name, person.name_en, language)
    position = both(person.position, person.position_en, language)
    when = label(wording.SIGNED, language)
    texts = [(person.name, part) for one in (name, position, when) for part in (one.main, one.second)]
    check_glyphs(texts)
    width, height = size
    buffer = io.BytesIO()
    canvas = Canvas(
        buffer,
        pagesize=size,
        invariant=1,
        initialFontName=REGULAR,  # type: ignore[arg-type] # the stub says float
    )
    pen = Pen(canvas)
    pen.box(0, 0, width, height, fill=_WHITE)
    lines: list[tuple[RichText, float, tuple[float, float, float]]] = [
        (bold(name.main), 14.0, ACCENT),
        (name.second, 8.0, ACCENT),
        (one_line(position), 7.5, INK),
        ((*one_line(when), *plain(f"  {signed.isoformat()}")), 7.0, GREY),
    ]
    shown = [(_fitted(text, size_, width - 8.0), ink) for text, size_, ink in lines if text]
    leading = height / len(shown)
    for index, ((text, size_), ink) in enumerate(shown):
        pen.text(4.0, height - leading * (index + 1) + (leading - size_ * 0.72) / 2, text, size_, ink=ink)
    canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def waiting_pdf(size: tuple[float, float], language: CertificateLanguage = "bilingual") -> bytes:
    """What an empty field shows until it is signed; the signature's appearance takes its place."""
    from reportlab.pdfgen.canvas import Canvas

    register_fonts()
    buffer = io.BytesIO()
    canvas = Canvas(
        buffer,
        pagesize=size,
        invariant=1,
        initialFontName=REGULAR,  # type: ignore[arg-type] # the stub says float
    )
    Pen(canvas).text(4.0, 5.0, one_line(label(wording.TO_BE_SIGNED, language)), 7.0, ink=GREY)
    canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def _fitted(text: RichText, size: float, width: float) -> tuple[RichText, float]:
    """On one line: smaller type for long names, and what is longer still ends in an ellipsis."""
    while size > 5.0 and text_width(text, size) > width:
        size -= 0.5
    if text_width(text, size) <= width:
        return text, size
    return (*wrap(text, size, width - text_width(plain("…"), size))[0], *plain("…")), size
