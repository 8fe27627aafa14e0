"""Draws the subset of Noto Sans SC that lies in resources/fonts. Not run at installation.

The certificate embeds its fonts with reportlab, which takes TrueType outlines only, and a Debian without a
Chinese font shows boxes. The npm package `@expo-google-fonts/noto-sans-sc` (OFL-1.1) has such outlines, 10 MB
a weight::

    npm pack @expo-google-fonts/noto-sans-sc && tar xzf expo-google-fonts-noto-sans-sc-*.tgz
    pip install -e .[assets]
    python packaging/make_fonts.py package

The digits of this font are all of one width, so columns of numbers need no `tnum` feature; it has none.
"""

from __future__ import annotations

import argparse
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FONTS = Path(__file__).resolve().parents[1] / "resources" / "fonts"
WEIGHTS = {
    "NotoSansSC-Regular.ttf": "400Regular/NotoSansSC_400Regular.ttf",
    "NotoSansSC-Bold.ttf": "700Bold/NotoSansSC_700Bold.ttf",
}

PUNCTUATION = "‐‑‒–—―‖‘’‚“”„†‡•…‰′″‹›※€™№℃℉Ω℧"
MATHEMATICS = "±×÷−∓∕·√∞∝∠∟∥∧∨∩∪∫∬∮∴∵≈≅≠≡≤≥≪≫⊕⊗⊥∀∂∃∅∆∇∈∉∋∏∑"
SIGNS = "←↑→↓↔↕↖↗↘↙⇒⇔■□▲△▶▷▼▽◀◁◆◇○◎●◐◑★☆✓⚠"
SCRIPTS = "¹²³⁴½¼¾"
CIRCLED = "①②③④⑤⑥⑦⑧⑨⑩⑪⑫⑬⑭⑮⑯⑰⑱⑲⑳"
# Characters that people are called by and that GB 2312 lacks: names stand on certificates.
NAMES = (
    "喆堃镕昇劼赟珺祎翀骉昉玥琤珮瑀犇焱垚燚旻昀晞晗炅煊烜熠瑄玮珂琦璟璠璐珩琰琮瑗瑛璇璨翊翯祺禛祐禔祯淏湉沄沚"
    "洺浠浥浛滢潆澍灏頔颀颢颙韫霁骁骐骢鹍皞晔暐曈曦昶旸昕晢筠璘璆璎瑢玹珣珒珹琇琎琲瑆璈璥瓒嫣嬿姝媛婳孆妍妘妤娴"
    "峣嵘崟嶶巘怿恺惇惔懋抃拏捷斓昃昊昳晅晖晙晟暄暕曚杺枥柷栩桤梃棪椤楸榛樾橦欤歆殳汭沇沨沅泂泖泚浔涴淙淯渼湜溦"
    "溱滉漪潞潼澄澔澧濂濯灝炘炜炫炴烔烨焓焜煜煦熜燊燏燨牁珅珏琛瑶甯畯畹皛皦眃睿矞砚硕磐祉祜禤稷穆竑竣笙筱箐"
    "篪簃粲綦缊翚翙翥耘聿胤舸艮芃芊芏芷苒苡茜荃荞莙菡菥萱葳蒨蓁蔚蔻薏藜蘅虓衎袆裬覃觅訚誉诒诩谌谖谡豫赓趸跱轩轶"
    "迓逯逵遥邈郗郦酆酉醴釉鈜鉴钊钰钲铉铖铠铧铭锜锴镔镠镡镱闫闳阊阗阚陟隽雍雱雯霄霏霓霖霭靓靖鞠韬韶顗颋颖颛飏飖"
    "馡馥驁驰驿骅骊骎骏骞骥髙魁魏鲲鸢鸾鸿鹂鹏鹤鹭麒麟黛黻黼鼐龑䶮"
)

# Glyphs the font lacks. Spaces: advance in thousandths of an em; numbers are grouped by thin spaces.
SPACES = {0x2007: 555, 0x2009: 200, 0x200A: 100, 0x202F: 200}
BALLOT_X = 0x2717

FEATURES = ["ccmp", "kern", "liga", "locl", "mark"]


def wanted_characters() -> set[int]:
    """Code points of the subset: GB 2312, Latin, Greek, and the signs of measurement."""
    ranges = [(0x20, 0x7F), (0xA0, 0x100), (0x391, 0x3AA), (0x3B1, 0x3CA), (0x3000, 0x3020), (0xFF01, 0xFF5F)]
    wanted = {code for first, end in ranges for code in range(first, end)}
    wanted.update(gb2312_characters())
    wanted.update(map(ord, PUNCTUATION + MATHEMATICS + SIGNS + SCRIPTS + CIRCLED + NAMES))
    return wanted


def gb2312_characters() -> Iterator[int]:
    """Code points of both levels of GB 2312, its signs included."""
    for row in range(0xA1, 0xF8):
        for cell in range(0xA1, 0xFF):
            text = bytes([row, cell]).decode("gb2312", errors="ignore")
            yield from map(ord, text)


def subset(source: Path, target: Path) -> set[int]:
    """Write the subset of one weight; returns the code points that were wanted and are not in the font."""
    from fontTools import subset as subsetting

    options = subsetting.Options(
        layout_features=FEATURES,
        drop_tables=["BASE", "vhea", "vmtx", "STAT"],
        name_IDs=["*"],
        notdef_outline=True,
        hinting=False,
        recalc_timestamp=False,
    )
    font = subsetting.load_font(str(source), options)
    subsetter = subsetting.Subsetter(options)
    wanted = wanted_characters()
    subsetter.populate(unicodes=wanted)
    subsetter.subset(font)
    add_missing_glyphs(font)
    lacking = wanted - set(font.getBestCmap())
    subsetting.save_font(font, str(target), options)
    return lacking


def add_missing_glyphs(font: Any) -> None:
    """Add the spaces that typeset numbers need, and the cross beside the check mark."""
    from fontTools.pens.ttGlyphPen import TTGlyphPen

    em = font["head"].unitsPerEm
    for code, advance in SPACES.items():
        add_glyph(font, code, TTGlyphPen(None).glyph(), advance * em // 1000)
    check = font["glyf"][font.getBestCmap()[ord("✓")]]
    pen = TTGlyphPen(None)
    draw_cross(pen, check.yMin, check.yMax, em)
    add_glyph(font, BALLOT_X, pen.glyph(), em)


def draw_cross(pen: Any, bottom: int, top: int, em: int) -> None:
    """Two bars at right angles, as high as the check mark and centred in the em."""
    middle_x, middle_y = em // 2, (bottom + top) // 2
    half, thick = (top - bottom) // 2 - em // 40, em // 22
    for side in (1, -1):
        corners = [(-half, -half + thick), (-half + thick, -half), (half, half - thick), (half - thick, half)]
        points = [(middle_x + side * x, middle_y + y) for x, y in corners]
        # Both bars wind the same way, else they would cancel where they cross.
        ordered = points if side == 1 else points[::-1]
        pen.moveTo(ordered[0])
        for point in ordered[1:]:
            pen.lineTo(point)
        pen.closePath()


def add_glyph(font: Any, code: int, glyph: Any, advance: int) -> None:
    """Add a glyph for a code point that the font does not map."""
    if code in font.getBestCmap():
        return
    name = f"uni{code:04X}"
    font.setGlyphOrder([*font.getGlyphOrder(), name])
    font["glyf"].glyphs[name] = glyph
    font["glyf"].glyphOrder = font.getGlyphOrder()
    glyph.recalcBounds(font["glyf"])
    font["hmtx"][name] = (advance, getattr(glyph, "xMin", 0))
    for table in font["cmap"].tables:
        if table.isUnicode() and table.format != 14:
            table.cmap[code] = name


def main() -> None:
    """Make both weights and put the licence beside them."""
    parser = argparse.ArgumentParser(description="Make resources/fonts from the unpacked npm package.")
    parser.add_argument("package", type=Path, help="folder that holds 400Regular/, 700Bold/ and LICENSE_FONT")
    package: Path = parser.parse_args().package
    FONTS.mkdir(parents=True, exist_ok=True)
    for target, source in WEIGHTS.items():
        lacking = subset(package / source, FONTS / target)
        size_mb = (FONTS / target).stat().st_size / 1e6
        print(f"{target}: {size_mb:.1f} MB; not in the font: {''.join(map(chr, sorted(lacking)))}")
    shutil.copyfile(package / "LICENSE_FONT", FONTS / "OFL.txt")


if __name__ == "__main__":
    main()
