"""Light and dark: readable, complete, and no character without a shape."""

from __future__ import annotations

from typing import get_args
from xml.etree import ElementTree

import pytest
from PySide6.QtGui import QColor, QFontMetrics, QRawFont

import translations
from ahrs_lab.ui import icons
from ahrs_lab.ui.theme import DARK, LIGHT, FontRole, Tokens, font, style_sheet, tokens
from tests.ui.conftest import Look

TEXTS = ("text", "muted", "accent", "good", "warn", "bad")
ON_TINT = (
    ("text", "accent_soft"), ("accent", "accent_soft"), ("good", "good_soft"), ("warn", "warn_soft"),
    ("bad", "bad_soft"), ("on_accent", "accent"), ("on_stop", "stop"), ("text", "page"), ("muted", "page"),
)  # fmt: skip


def luminance(colour: QColor) -> float:
    """WCAG 2.2, relative luminance."""

    def linear(channel: float) -> float:
        return channel / 12.92 if channel <= 0.04045 else float(((channel + 0.055) / 1.055) ** 2.4)

    return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) + 0.0722 * linear(colour.blueF())


def contrast(one: QColor, other: QColor) -> float:
    """WCAG 2.2, contrast ratio."""
    bright, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize(("text", "ground"), [*((text, "card") for text in TEXTS), *ON_TINT])
def test_texts_can_be_read(theme: Tokens, text: str, ground: str) -> None:
    assert contrast(theme.colour(text), theme.colour(ground)) >= 4.5


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_style_sheet_names_only_colours_that_there_are(theme: Tokens) -> None:
    assert "$" not in style_sheet(theme)


def test_switch_at_run_time(look: Look) -> None:
    assert tokens() is LIGHT
    look.theme.set_mode("dark")
    assert tokens() is DARK
    look.theme.set_mode("light")
    assert tokens() is LIGHT


def test_system_follows_the_desktop(look: Look) -> None:
    look.theme.set_mode("system")
    assert look.theme.mode == "system"
    assert tokens() in (LIGHT, DARK)


def test_digits_have_equal_width_in_every_size(look: Look) -> None:
    for role in get_args(FontRole):
        metrics = QFontMetrics(font(role))
        assert len({metrics.horizontalAdvance(digit) for digit in "0123456789"}) == 1


def test_every_character_of_the_screens_texts_has_a_shape(look: Look) -> None:
    root = ElementTree.parse(translations.TEXTS).getroot()
    used = {c for name in ("source", "translation") for node in root.iter(name) for c in node.text or ""}
    used |= set("±−×′″°\u2009…→–·Ωωφ")
    for role in get_args(FontRole):
        raw = QRawFont.fromFont(font(role))
        assert sorted(c for c in used if c.isprintable() and not raw.supportsCharacter(ord(c))) == []


def test_every_icon_is_drawn(look: Look) -> None:
    for name in icons.names():
        picture = icons.pixmap(name, "#102030", 24).toImage()
        assert any(picture.pixelColor(x, y).alpha() for x in range(24) for y in range(24)), name
