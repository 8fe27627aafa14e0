"""Fills pages with boxes, and draws what stands on every page: header, footer, banner, page x of y."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from ahrs_lab.certificates.boxes import GAP, Box, FieldsBox, HeadingBox, TextBox
from ahrs_lab.certificates.documents import (
    Block,
    Chart,
    DocumentFrame,
    Fields,
    Heading,
    Label,
    LineChart,
    Paragraph,
    Table,
)
from ahrs_lab.certificates.drawing import (
    ACCENT,
    GREY,
    INK,
    WARNING,
    Pen,
    colour,
    text_width,
    wrap,
)
from ahrs_lab.certificates.line_chart import LineChartBox
from ahrs_lab.certificates.plot import ChartBox
from ahrs_lab.certificates.richtext import RichText, bold, grey, joined, markup
from ahrs_lab.certificates.tables import TableBox
from ahrs_lab.certificates.watermark import watermark

PAGE_WIDTH, PAGE_HEIGHT = 595.276, 841.89
MARGIN = 54.0
WIDTH = PAGE_WIDTH - 2 * MARGIN
BOTTOM = 74.0
"""Lowest line of the contents; the footer is below."""
_BAND = 15.0
_TOP = PAGE_HEIGHT - 38.0
_BANNER = 20.0
_NAME_SIZE, _SECOND_SIZE, _SMALL = 12.0, 8.0, 7.5


@dataclass
class Page:
    """Boxes with the line below which each is drawn."""

    placed: list[tuple[Box, float]] = field(default_factory=list)
    room_below: float = 0.0


def box_of(block: Block, labels: tuple[float, float] | None = None) -> Box:
    """The box that measures and draws ``block``."""
    match block:
        case Fields():
            return FieldsBox(block, labels)
        case Table():
            return TableBox(block)
        case Paragraph():
            return TextBox.of(block)
        case Heading():
            return HeadingBox(block)
        case Chart():
            return ChartBox(block)
        case LineChart():
            return LineChartBox(block)


def boxes_of(blocks: Sequence[Block]) -> list[Box]:
    """The boxes of ``blocks``; all fields share their label columns."""
    labels = FieldsBox.label_widths([block for block in blocks if isinstance(block, Fields)])
    return [box_of(block, labels) for block in blocks]


def flow(boxes: Sequence[Box], first_top: float, top: float, bottom: float) -> list[Page]:
    """Pages filled from above; a heading is never left alone at the end of a page."""
    pages = [Page()]
    y = first_top
    waiting = list(boxes)
    while waiting:
        box = waiting.pop(0)
        start = y - (box.space_before if pages[-1].placed else 0.0)
        needed = box.height(WIDTH) + _company(box, waiting)
        if start - needed >= bottom:
            pages[-1].placed.append((box, start))
            y = start - box.height(WIDTH)
            continue
        parts = box.cut(WIDTH, start - bottom)
        if parts is not None:
            pages[-1].placed.append((parts[0], start))
            waiting.insert(0, parts[1])
        elif not pages[-1].placed and y >= top - 0.01:
            # Higher than a whole page and cannot be cut: better drawn below the edge than not at all.
            pages[-1].placed.append((box, start))
        else:
            waiting.insert(0, box)
        pages[-1].room_below = y - bottom
        pages.append(Page())
        y = top
    pages[-1].room_below = y - bottom
    return pages


def _company(box: Box, following: Sequence[Box]) -> float:
    """Room that must remain below ``box`` for what it may not be parted from."""
    if not box.keep_with_next or not following:
        return 0.0
    after = following[0]
    whole = after.height(WIDTH)
    starts = (60.0, 90.0, 120.0)
    least = next((some for some in starts if after.cut(WIDTH, min(whole - 0.1, some)) is not None), whole)
    return after.space_before + least + _company(after, following[1:])


class FrameDrawing:
    """Header, footer, banner and watermark of one document; measured once."""

    def __init__(self, frame: DocumentFrame) -> None:
        self._frame = frame
        right = max(text_width(self._number(), 9.5), text_width(self._page_text(88, 88), _SMALL))
        self._left_room = WIDTH - right - 2 * GAP

    def _number(self) -> RichText:
        name = self._frame.number_label
        return joined(bold(name.main), " ", grey(name.second), " ", bold(self._frame.number))

    def _page_text(self, page: int, pages: int) -> RichText:
        words = self._frame.page_of.filled(page=page, pages=pages)
        if self._frame.language == "en":
            return markup(words.en)
        if self._frame.language == "zh":
            return markup(words.zh)
        return joined(words.zh, "   ", words.en)

    def _name_lines(self, *, address: bool) -> list[tuple[RichText, float]]:
        name, place = self._frame.laboratory, self._frame.laboratory_address
        lines = [(line, _NAME_SIZE) for line in wrap(bold(name.main), _NAME_SIZE, self._left_room)]
        lines += [(line, _SECOND_SIZE) for line in wrap(name.second, _SECOND_SIZE, self._left_room)]
        if address:
            lines += [
                (line, _SMALL)
                for part in (place.main, place.second)
                for line in wrap(part, _SMALL, self._left_room)
                if line
            ]
        return [(line, size) for line, size in lines if line]

    def _header_height(self, *, first: bool) -> float:
        names = sum(size * 1.35 for _, size in self._name_lines(address=first))
        return max(names, 9.5 * 1.5 + _SMALL * 1.5) + 6.0

    def content_top(self, *, first: bool) -> float:
        """Where the contents begin."""
        banner = _BANNER + 10.0 if self._frame.banner is not None else 0.0
        return _TOP - self._header_height(first=first) - 14.0 - banner

    def draw(self, pen: Pen, page: int, pages: int) -> None:
        """All that is not contents."""
        first = page == 1
        if self._frame.banner is not None:
            self._watermark(pen)
        pen.box(0, PAGE_HEIGHT - _BAND, PAGE_WIDTH, _BAND, fill=ACCENT)
        y = _TOP
        for line, size in self._name_lines(address=first):
            y -= size * 1.35
            pen.text(MARGIN, y + size * 0.3, line, size, ink=INK if size == _NAME_SIZE else GREY)
        right = PAGE_WIDTH - MARGIN
        pen.text(right, _TOP - 9.5 * 1.05, self._number(), 9.5, align="right")
        pen.text(
            right,
            _TOP - 9.5 * 1.5 - _SMALL * 1.15,
            self._page_text(page, pages),
            _SMALL,
            ink=GREY,
            align="right",
        )
        rule = _TOP - self._header_height(first=first)
        pen.rule(MARGIN, rule, right, rule)
        if self._frame.banner is not None:
            self._banner(pen, self._frame.banner, rule - 10.0)
        self._footer(pen)

    def _banner(self, pen: Pen, banner: Label, top: float) -> None:
        pen.box(MARGIN, top - _BANNER, WIDTH, _BANNER, fill=colour("#FDF1F0"), edge=WARNING, radius=3.0)
        text = joined(bold(banner.main), "   " if banner.second else "", bold(banner.second))
        pen.text(PAGE_WIDTH / 2, top - _BANNER + 6.4, text, 10.0, ink=WARNING, align="centre")

    def _watermark(self, pen: Pen) -> None:
        words, size = ("DEMONSTRATION", 58.0) if self._frame.language == "en" else ("演 示", 150.0)
        picture, width, height = watermark(words, size)
        pen.canvas.drawImage(picture, (PAGE_WIDTH - width) / 2, (PAGE_HEIGHT - height) / 2, width, height)

    def _footer(self, pen: Pen) -> None:
        y = BOTTOM - 12.0
        pen.rule(MARGIN, y, PAGE_WIDTH - MARGIN, y)
        footer = self._frame.footer
        for part in (footer.main, footer.second):
            for line in wrap(part, 6.8, WIDTH):
                y -= 10.0
                pen.text(MARGIN, y, line, 6.8, ink=GREY)


def draw_page(pen: Pen, page: Page) -> None:
    """The contents of one page."""
    for box, top in page.placed:
        box.draw(pen, MARGIN, top, WIDTH)
