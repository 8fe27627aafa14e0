"""The page: all inside its margins, nothing over anything else, fonts embedded, the same every time."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from datetime import date
from itertools import combinations
from pathlib import Path

import pikepdf
import pytest

from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.documents import Column, Table, Words, label, same
from ahrs_lab.certificates.drawing import text_width, wrap
from ahrs_lab.certificates.fonts import register_fonts
from ahrs_lab.certificates.job_sheet import CertificateLanguage, JobSheet, Party, Person
from ahrs_lab.certificates.pages import MARGIN, PAGE_WIDTH
from ahrs_lab.certificates.plot import nice_ticks
from ahrs_lab.certificates.plots import plots_pdf
from ahrs_lab.certificates.richtext import plain, text_of
from ahrs_lab.certificates.tables import TableBox, column_widths
from ahrs_lab.errors import InputError
from ahrs_lab.metrology.conditions import Standard
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.rounding import format_grouped
from ahrs_lab.resource_files import resource_path
from tests.certificates.conftest import STANDARDS
from tests.certificates.pdf_text import Span, lines, spans, whole_text

LONG_ZH = "国家惯性技术计量与航空航天仪器综合检测校准技术研究中心华北分中心第二实验室" * 2
LONG_EN = "National Centre for Metrology of Inertial Technology and Aerospace Instrumentation, " * 3
SERIAL_40 = "SN-0123456789-ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def stressed(job: JobSheet) -> JobSheet:
    party = Party(LONG_ZH, LONG_ZH + "甲 1 号", LONG_EN, LONG_EN)
    standard = Standard(
        kind="other",
        name=LONG_EN,
        name_zh=LONG_ZH,
        manufacturer="Manufacturer",
        model=SERIAL_40,
        serial_number=SERIAL_40,
        accuracy="U_rel = 2×10^{−4} " * 6,
        accuracy_zh="",
        certificate_number=SERIAL_40,
        due=date(2027, 3, 1),
    )
    person = Person("欧阳" * 14, LONG_ZH, "Maximiliana-Alexandra " * 4, LONG_EN)
    return replace(
        job,
        laboratory=party,
        customer=party,
        device=replace(job.device, name=LONG_ZH, name_en=LONG_EN, manufacturer=LONG_EN, model=SERIAL_40 * 3),
        operator=person,
        verifier=person,
        approver=person,
        place=LONG_ZH,
        place_en=LONG_EN,
        standards=(standard,) * 12,
        notes=(LONG_EN * 3, LONG_ZH * 3, "W" * 300),
        certificate_number=SERIAL_40,
        demonstration=True,
    )


def outside(found: list[Span]) -> Iterator[Span]:
    for span in found:
        blank = not span.text.strip()
        fits = span.x >= MARGIN - 0.6 and span.x + span.width <= PAGE_WIDTH - MARGIN + 0.6
        if not blank and not (fits and 20 <= span.y <= 830):
            yield span


def overlapping(found: list[Span]) -> Iterator[tuple[Span, Span]]:
    inked = [span for span in found if span.text.strip()]
    for page in {span.page for span in inked}:
        yield from ((a, b) for a, b in combinations([s for s in inked if s.page == page], 2) if a.overlaps(b))


@pytest.mark.parametrize(
    ("language", "stress"),
    [("bilingual", False), ("zh", False), ("en", False), ("bilingual", True), ("en", True)],
)
def test_nothing_is_clipped_and_nothing_overlaps(
    tmp_path: Path, result: CalibrationResult, job: JobSheet, language: CertificateLanguage, stress: bool
) -> None:
    path = certificate_pdf(result, stressed(job) if stress else job, tmp_path / "c.pdf", language)
    found = spans(path)
    assert list(outside(found)) == []
    assert list(overlapping(found)) == []


def test_long_texts_are_printed_whole(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    path = certificate_pdf(result, stressed(job), tmp_path / "c.pdf", "zh")
    text = "".join(span.text for span in spans(path)).replace(" ", "")
    assert text.count(SERIAL_40 * 3) >= 1
    assert text.count("华北分中心第二实验室") >= 6
    # a page may end within the long word
    assert sum(map(len, re.findall("W{20,}", text))) == 300


def test_the_overlap_check_can_fail() -> None:
    first = Span(0, 100, 100, 10, 50, "first")
    assert first.overlaps(Span(0, 140, 103, 10, 50, "second"))
    assert not first.overlaps(Span(0, 151, 100, 10, 50, "beside"))
    assert not first.overlaps(Span(0, 100, 113, 10, 50, "above"))


def test_every_page_has_its_number_and_the_certificates(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    path = certificate_pdf(result, job, tmp_path / "c.pdf")
    with pikepdf.open(path) as pdf:
        count = len(pdf.pages)
    assert count >= 3
    for page in range(count):
        text = " ".join(" ".join(lines(path, page)).split())
        assert f"第 {page + 1} 页 共 {count} 页 Page {page + 1} of {count}" in text
        assert "AL-2026-0142" in text
        assert "演示校准实验室" in text


def fonts_of(pdf: pikepdf.Pdf) -> Iterator[pikepdf.Object]:
    for item in pdf.objects:
        if isinstance(item, pikepdf.Dictionary) and item.get("/Type") == "/Font":
            yield item


def test_every_font_is_embedded(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    for path in (
        certificate_pdf(result, job, tmp_path / "c.pdf"),
        plots_pdf(result, tmp_path / "p.pdf"),
    ):
        with pikepdf.open(path) as pdf:
            found = list(fonts_of(pdf))
            assert found
            assert all("/FontFile2" in font.FontDescriptor for font in found)


@pytest.mark.skipif(shutil.which("pdffonts") is None, reason="pdffonts (poppler-utils) is not installed")
def test_pdffonts_agrees_that_every_font_is_embedded(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    path = certificate_pdf(result, job, tmp_path / "c.pdf")
    table = subprocess.run(["pdffonts", str(path)], capture_output=True, text=True, check=True).stdout
    rows = [row.split() for row in table.splitlines()[2:]]
    assert rows
    assert all("NotoSansSC" in row[0] and row[-5] == "yes" for row in rows)


def test_the_same_contents_make_the_same_bytes(
    tmp_path: Path, result: CalibrationResult, demonstration_job: JobSheet
) -> None:
    first = certificate_pdf(result, demonstration_job, tmp_path / "1.pdf").read_bytes()
    second = certificate_pdf(result, demonstration_job, tmp_path / "2.pdf").read_bytes()
    assert first == second


def test_the_file_says_what_it_is(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    with pikepdf.open(certificate_pdf(result, job, tmp_path / "c.pdf", "en")) as pdf:
        assert str(pdf.docinfo["/Title"]) == "CALIBRATION CERTIFICATE AL-2026-0142"
        assert str(pdf.docinfo["/Author"]) == "Demonstration Calibration Laboratory"
        assert "/Producer" not in pdf.docinfo
        assert str(pdf.Root.Lang) == "en"
        assert [str(field.T) for field in pdf.Root.AcroForm.Fields] == ["operator", "verifier", "approver"]
        width, height = (float(value) for value in pdf.pages[0].MediaBox[2:])
    assert (width, height) == pytest.approx((210 / 25.4 * 72, 297 / 25.4 * 72), abs=0.01)


@pytest.mark.parametrize("simulated", [False, True])
def test_a_demonstration_says_so_on_every_page(
    tmp_path: Path, result: CalibrationResult, job: JobSheet, simulated: bool
) -> None:
    marked = (
        certificate_pdf(replace(result, simulated=True), job, tmp_path / "c.pdf")
        if simulated
        else certificate_pdf(result, replace(job, demonstration=True), tmp_path / "c.pdf")
    )
    with pikepdf.open(marked) as pdf:
        count = len(pdf.pages)
    for page in range(count):
        assert "DEMONSTRATION — not a valid certificate" in " ".join(lines(marked, page))
    real = certificate_pdf(result, job, tmp_path / "real.pdf")
    assert "not a valid certificate" not in whole_text(real)


def images_on_first_page(path: Path) -> int:
    with pikepdf.open(path) as pdf:
        return len(pdf.pages[0].get_images())


def test_the_seal_is_the_jobs_and_never_the_demonstrations_on_a_real_certificate(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    assert images_on_first_page(certificate_pdf(result, job, tmp_path / "none.pdf")) == 0
    assert "校准专用章" in whole_text(tmp_path / "none.pdf")
    sealed = replace(job, seal=resource_path("seal/demo-seal.png"))
    assert images_on_first_page(certificate_pdf(result, sealed, tmp_path / "seal.pdf")) == 1
    demonstrated = certificate_pdf(result, replace(job, demonstration=True), tmp_path / "demo.pdf")
    assert images_on_first_page(demonstrated) == 2, "seal and watermark"


def test_a_seal_that_is_no_image_is_refused(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    seal = tmp_path / "seal.png"
    seal.write_bytes(b"not a picture")
    with pytest.raises(InputError, match="not a PNG image"):
        certificate_pdf(result, replace(job, seal=seal), tmp_path / "c.pdf")


@pytest.mark.parametrize("character", ["ก", "😀", "\u202e", "\ue000"])
def test_a_character_without_a_glyph_is_refused_by_name(
    tmp_path: Path, result: CalibrationResult, job: JobSheet, character: str
) -> None:
    named = replace(job, customer=replace(job.customer, name=f"公司{character}"))
    with pytest.raises(InputError) as refused:
        certificate_pdf(result, named, tmp_path / "c.pdf")
    assert f"U+{ord(character):04X}" in str(refused.value)
    assert "送校单位" in str(refused.value)
    assert not (tmp_path / "c.pdf").exists()


def test_unicode_superscripts_of_others_are_set_as_raised_text(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    noted = replace(job, notes=("Stable to 2×10⁻⁴, H₂O",))
    found = spans(certificate_pdf(result, noted, tmp_path / "c.pdf", "en"))
    raised = next(span for span in found if span.text == "−4" and span.size < 6)
    base = next(span for span in found if span.text.endswith("2×10"))
    assert raised.y > base.y
    assert raised.size < base.size


def test_columns_are_as_wide_as_their_content() -> None:
    register_fonts()
    table = Table(
        (Column(same("A")), Column(same("B"), align="right")),
        ((same("short"), same("1.002 335")), (same("a much longer text than the heading"), same("−0.5"))),
    )
    size, widths = column_widths(table, 300.0)
    assert size == table.size
    for column, width in enumerate(widths):
        assert all(text_width(row[column].main, size) <= width for row in table.rows)


def test_numbers_are_never_cut_and_long_words_are() -> None:
    register_fonts()
    columns = (Column(same("Name")), *(Column(same("N"), align="right") for _ in range(5)))
    number = format_grouped("-0.000268912345")
    table = Table(columns, ((same("x" * 60), *[same(number)] * 5),))
    size, widths = column_widths(table, 487.0)
    assert all(len(wrap(plain(number), size, width)) == 1 for width in widths[1:])
    assert len(wrap(plain("x" * 60), size, widths[0])) > 1


@pytest.mark.parametrize("width", [30.0, 80.0, 200.0])
def test_wrapped_lines_fit_and_keep_every_character(width: float) -> None:
    register_fonts()
    text = (
        "零偏 B 为所述条件下各时段输出的平均值，其 U 不包含 (bias instability) 他日的变化；Antidisestablish。"
    )
    wrapped = wrap(plain(text), 8.0, width)
    assert all(text_width(line, 8.0) <= width + 0.01 for line in wrapped)
    assert "".join(text_of(line) for line in wrapped).replace(" ", "") == text.replace(" ", "")
    if width > 50:
        assert not any(text_of(line)[0] in "，。；）" for line in wrapped)


@pytest.mark.parametrize("span", ["(10～1000)", "(10–1000)"])
def test_a_range_is_not_parted(span: str) -> None:
    register_fonts()
    for width in range(70, 200, 5):
        wrapped = wrap(plain(f"准确度等级 U = 2 %，{span} °/s，k = 2；U = 10″，k = 2"), 8.0, float(width))
        assert any(span in text_of(line) for line in wrapped)


def test_ticks_are_round_and_span_the_data() -> None:
    assert nice_ticks(-7.3, 11.0) == pytest.approx((-10, -5, 0, 5, 10, 15))
    assert nice_ticks(0.0, 0.0)
    assert nice_ticks(-0.02, 0.013)[0] <= -0.02


def test_twelve_standards_and_many_warnings_flow_on(
    tmp_path: Path, result: CalibrationResult, job: JobSheet
) -> None:
    many = replace(result, warnings=result.warnings * 40)
    path = certificate_pdf(many, replace(job, standards=STANDARDS * 4), tmp_path / "c.pdf", "en")
    text = whole_text(path)
    assert text.count("T-0007") == 4
    assert "The unit was warm (×40)" in text


def test_footnotes_stay_together(tmp_path: Path, result: CalibrationResult, job: JobSheet) -> None:
    many = replace(job, standards=STANDARDS * 2, demonstration=True)
    path = certificate_pdf(result, many, tmp_path / "c.pdf")
    pages = {
        span.page for span in spans(path) for note in ("名称与顺序按附录", "450 不适用") if note in span.text
    }
    assert len(pages) == 1


def test_a_scale_has_two_ticks_even_where_all_is_zero() -> None:
    assert len(nice_ticks(0.0, 0.0)) == 2


def test_no_page_has_less_than_three_rows_of_a_table_that_is_cut() -> None:
    register_fonts()
    table = Table((Column(same("n")),), tuple((same(str(n)),) for n in range(40)), kept=True)
    box = TableBox(table)
    high = box.height(400.0)
    cuts = [parts for room in range(20, int(high)) if (parts := box.cut(400.0, float(room))) is not None]
    assert len(cuts) > 100
    row = (high - box._header_height(400.0)) / 41
    for first, rest in cuts:
        assert first.height(400.0) - box._header_height(400.0) > 3 * row
        assert rest.height(400.0) - box._header_height(400.0) > 3 * row
        assert (first.keep_with_next, rest.keep_with_next) == (False, True)


def test_an_equation_is_not_parted_and_english_marks_are_narrow() -> None:
    register_fonts()
    for width in range(40, 200, 5):
        for line in wrap(plain("coverage factor k = 2 and some more words"), 8.0, float(width)):
            assert not text_of(line).replace("\N{NO-BREAK SPACE}", " ").startswith(("= 2", "2 "))
    assert text_of(label(Words("“一”…", "“a” …"), "bilingual").second) == '"a" ...'
