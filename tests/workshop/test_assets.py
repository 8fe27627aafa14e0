"""The fonts, the seal and the icon that the application ships."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

RESOURCES = Path(__file__).resolve().parents[2] / "resources"
WEIGHTS = ["Regular", "Bold"]
PRINTED = (
    "°′″±×÷·−–—…≤≥≈≠√ΣΩΔωφψθγαβδσμµ∇∞→←↑↓■●○▶✓✗⚠，、。「」《》（）：；“”①②③④⑤⑥⑦⑧⑨⑩"
    "\N{THIN SPACE}\N{NARROW NO-BREAK SPACE}\N{NO-BREAK SPACE}\N{FIGURE SPACE}"
    "校准证书航姿参考系统标度因数零偏失准角喆堃镕"
)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_font_has_every_character_that_is_printed(weight: str) -> None:
    from reportlab.pdfbase.ttfonts import TTFontFile

    glyphs = TTFontFile(str(RESOURCES / "fonts" / f"NotoSansSC-{weight}.ttf")).charToGlyph
    latin = "".join(map(chr, [*range(0x20, 0x7F), *range(0xA0, 0x100)]))
    chinese = bytes(c for row in range(0xB0, 0xF8) for cell in range(0xA1, 0xFF) for c in (row, cell))
    level_1_and_2 = chinese.decode("gb2312", errors="ignore")
    assert len(level_1_and_2) >= 6763
    assert [c for c in PRINTED + latin + level_1_and_2 if ord(c) not in glyphs] == []


@pytest.mark.parametrize("weight", WEIGHTS)
def test_digits_are_of_one_width(weight: str) -> None:
    from reportlab.pdfbase.ttfonts import TTFontFile

    widths = TTFontFile(str(RESOURCES / "fonts" / f"NotoSansSC-{weight}.ttf")).charWidths
    assert len({widths[ord(digit)] for digit in "0123456789"}) == 1


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="pdftotext (poppler-utils) is not installed")
def test_text_comes_back_from_a_pdf(tmp_path: Path) -> None:
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    text = "校准证书 K = 1.002335 ± 0.0004 (°/s)/(°/s)，θ = −5.3″"
    pdfmetrics.registerFont(TTFont("workshop", str(RESOURCES / "fonts" / "NotoSansSC-Regular.ttf")))
    canvas = Canvas(str(tmp_path / "page.pdf"))
    canvas.setFont("workshop", 12)
    canvas.drawString(50, 700, text)
    canvas.save()
    found = subprocess.run(
        ["pdftotext", "-enc", "UTF-8", str(tmp_path / "page.pdf"), "-"],
        check=True,
        capture_output=True,
        encoding="utf-8",
    )
    assert found.stdout.strip() == text


def test_licence_lies_beside_the_fonts() -> None:
    assert "SIL OPEN FONT LICENSE" in (RESOURCES / "fonts" / "OFL.txt").read_text(encoding="utf-8")


def test_seal_is_transparent_and_says_demonstration() -> None:
    from PySide6.QtGui import QImage

    assert "DEMO" in (RESOURCES / "seal" / "demo-seal.svg").read_text(encoding="utf-8")
    image = QImage(str(RESOURCES / "seal" / "demo-seal.png"))
    assert (image.width(), image.height()) == (600, 600)
    assert image.pixelColor(0, 0).alpha() == 0
    assert image.pixelColor(300, 14).red() > 180


def test_icon_is_drawn_without_complaint(qapp: object) -> None:
    from PySide6.QtSvg import QSvgRenderer

    assert QSvgRenderer(str(RESOURCES / "icons" / "ahrs-lab.svg")).isValid()
