"""What a printed document is made of, before anybody decides where it stands on a page.

All texts are final: rounded, in the languages asked for. The layout only measures and places them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.certificates.richtext import RichText, Run, markup, plain, text_of
from ahrs_lab.messages import Message

Align = Literal["left", "right"]


@dataclass(frozen=True)
class Words:
    """Our own wording in both scripts, side by side so that they stay the same; ``_{}`` lowers, ``^{}``
    raises."""

    zh: str
    en: str

    def filled(self, **values: object) -> Words:
        """With ``{name}`` replaced in both."""
        return Words(self.zh.format(**values), self.en.format(**values))


@dataclass(frozen=True)
class Label:
    """A text in the document's first language and, in a bilingual one, small and grey in the second."""

    main: RichText
    second: RichText = ()


EMPTY = Label(())
LATIN_MARKS = str.maketrans({"…": "...", "“": '"', "”": '"', "‘": "'", "’": "'"})
"""The fonts draw these as wide as a Chinese character."""
_QUANTITY = re.compile(r"(?:(?<=\b[KBL])|(?<=\bF0))_([xyz]{1,2})\b")


def label(words: Words, language: CertificateLanguage) -> Label:
    """Our own wording in the languages of the document."""
    english = markup(words.en.translate(LATIN_MARKS))
    if language == "en":
        return Label(english)
    return Label(markup(words.zh), english if language == "bilingual" and words.en != words.zh else ())


def both(zh: str, en: str, language: CertificateLanguage) -> Label:
    """Somebody else's text (a name, an address): as it stands, in the scripts that exist."""
    if language == "en":
        return Label(plain(en or zh))
    return Label(plain(zh or en), plain(en) if language == "bilingual" and en and zh and en != zh else ())


def spoken(message: Message, language: CertificateLanguage) -> Label:
    """What the software says, with the indices of quantities lowered (``B_x``)."""
    text = both(message.text("zh"), message.text("en").translate(LATIN_MARKS), language)
    return Label(_lowered(text.main), _lowered(text.second))


def _lowered(text: RichText) -> RichText:
    runs: list[Run] = []
    for run in text:
        for number, part in enumerate(_QUANTITY.split(run.text)):
            if part:
                runs.append(replace(run, text=part, shift="sub" if number % 2 else run.shift))
    return tuple(runs)


def same(text: str | RichText) -> Label:
    """A text that is the same in every language, as a serial number."""
    return Label(plain(text) if isinstance(text, str) else text)


@dataclass(frozen=True)
class Field:
    """A line of the front page: what it is, and its value."""

    label: Label
    value: Label


@dataclass(frozen=True)
class Fields:
    """Lines that belong together; labels share one column."""

    fields: tuple[Field, ...]
    ruled: bool = True
    """Whether a line stands above them."""


@dataclass(frozen=True)
class Column:
    """A column's heading; ``unit`` is set after it in grey."""

    label: Label
    unit: RichText = ()
    align: Align = "left"
    strong: bool = False


@dataclass(frozen=True)
class Table:
    """Rows of cells, as many as columns."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[Label, ...], ...]
    size: float = 8.5
    summary_rows: int = 0
    """So many rows at the end stand in bold below a line."""
    kept: bool = False
    """On one page with what follows."""
    whole: bool = False
    """Not cut, unless it is longer than most of a page."""


@dataclass(frozen=True)
class Paragraph:
    """Running text; ``mark`` is a footnote's number. ``together``: both languages run on in one paragraph."""

    text: Label
    mark: str = ""
    size: float = 8.0
    together: bool = False
    kept: bool = False
    """On one page with what follows."""


@dataclass(frozen=True)
class Heading:
    """A numbered heading; level 2 stands above a single table or picture."""

    label: Label
    number: str = ""
    level: Literal[1, 2] = 1


@dataclass(frozen=True)
class Series:
    """Points of one axis: ``error`` is half an error bar (0: none); ``curve`` a line drawn through."""

    axis: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    error: tuple[float, ...] = ()
    curve: tuple[tuple[float, float], ...] = ()
    title: RichText = ()
    names: tuple[str, ...] = ()
    """Written at the points' places instead of numbers."""


@dataclass(frozen=True)
class Chart:
    """Small panels side by side, one a series, with the same scales."""

    panels: tuple[Series, ...]
    x_label: Label
    y_label: Label
    x_ticks: tuple[float, ...] = ()
    height: float = 118.0


@dataclass(frozen=True)
class Line:
    """One curve of a :class:`LineChart`: ``low`` and ``high`` are its band where there is one.

    A value that is not finite leaves a gap. ``axis`` x, y, z takes the axis' colour; "" the next of the
    chart's own."""

    label: Label
    points: tuple[tuple[float, float], ...]
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    axis: str = ""
    style: Literal["line", "dashed", "points"] = "line"


@dataclass(frozen=True)
class LineChart:
    """Curves on one pair of axes over the whole width, with a legend; ``marks`` are upright lines with their
    names. ``equal``: both axes have one scale."""

    lines: tuple[Line, ...]
    x_label: Label
    y_label: Label
    marks: tuple[tuple[float, Label], ...] = ()
    log_x: bool = False
    log_y: bool = False
    equal: bool = False
    height: float = 138.0
    """Points; three such charts with their headings fill a page."""


Block = Fields | Table | Paragraph | Heading | Chart | LineChart


@dataclass(frozen=True)
class SignatureBox:
    """Where a person signs; ``role`` is the field's name in the file."""

    role: Literal["operator", "verifier", "approver"]
    label: Label
    person: Label
    position: Label


@dataclass(frozen=True)
class DocumentFrame:
    """What stands on every page, and what the file says of itself."""

    laboratory: Label
    laboratory_address: Label
    number_label: Label
    number: RichText
    page_of: Words
    language: CertificateLanguage
    footer: Label
    banner: Label | None
    title: Label
    file_title: str
    file_subject: str


@dataclass(frozen=True)
class Document:
    """A document: the front (title, fields, signatures) and what follows on further pages."""

    frame: DocumentFrame
    front: tuple[Block, ...]
    signatures: tuple[SignatureBox, ...]
    pages: tuple[tuple[Block, ...], ...] = ()
    """Each group begins on a new page."""
    seal: Path | None = None
    """Image of the laboratory's seal; without it a place for the stamp is drawn."""


def _of_label(where: str, item: Label) -> Iterator[tuple[str, RichText]]:
    yield where, item.main
    yield where, item.second


def _of_block(block: Block) -> Iterator[tuple[str, RichText]]:
    match block:
        case Fields(fields):
            for one in fields:
                yield from _of_label(text_of(one.label.main), one.label)
                yield from _of_label(text_of(one.label.main), one.value)
        case Table(columns, rows):
            for column in columns:
                yield from _of_label(text_of(column.label.main), column.label)
                yield text_of(column.label.main), column.unit
            for row in rows:
                for column, cell in zip(columns, row, strict=True):
                    yield from _of_label(text_of(column.label.main), cell)
        case Paragraph(text) | Heading(text):
            yield from _of_label(text_of(text.main)[:30], text)
        case Chart(panels, x_label, y_label):
            yield from _of_label(text_of(x_label.main), x_label)
            yield from _of_label(text_of(y_label.main), y_label)
            for panel in panels:
                yield text_of(panel.title), panel.title
        case LineChart(lines, x_label, y_label, marks):
            for item in (x_label, y_label, *(line.label for line in lines), *(name for _, name in marks)):
                yield from _of_label(text_of(item.main), item)


def texts_of(document: Document) -> Iterator[tuple[str, RichText]]:
    """Every text with the name of where it stands, for the check of glyphs."""
    frame = document.frame
    for item in (frame.laboratory, frame.laboratory_address, frame.number_label, frame.footer, frame.title):
        yield from _of_label(text_of(item.main)[:30], item)
    yield text_of(frame.number_label.main), frame.number
    if frame.banner is not None:
        yield from _of_label(text_of(frame.banner.main), frame.banner)
    for box in document.signatures:
        for item in (box.label, box.person, box.position):
            yield from _of_label(text_of(box.label.main), item)
    for group in (document.front, *document.pages):
        for block in group:
            yield from _of_block(block)
