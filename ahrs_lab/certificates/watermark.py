"""The demonstration's mark behind the text: a picture, so that who copies or reads the text is not
disturbed by it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ahrs_lab.certificates.fonts import BOLD, font_file

if TYPE_CHECKING:
    from reportlab.lib.utils import ImageReader

_PIXELS_PER_POINT = 1.6
_TURN_DEG = 52
_PAPER, _INK = (255, 255, 255), (250, 238, 237)


@cache
def watermark(words: str, size: float) -> tuple[ImageReader, float, float]:
    """The picture of ``words`` turned upward, on white, and its width and height in points."""
    from PIL import Image, ImageDraw, ImageFont
    from reportlab.lib.utils import ImageReader

    font = ImageFont.truetype(str(font_file(BOLD)), round(size * _PIXELS_PER_POINT))
    left, top, right, bottom = font.getbbox(words)
    image = Image.new("RGB", (round(right - left) + 8, round(bottom - top) + 8), _PAPER)
    ImageDraw.Draw(image).text((4 - left, 4 - top), words, font=font, fill=_INK)
    turned = image.rotate(_TURN_DEG, resample=Image.Resampling.BICUBIC, expand=True, fillcolor=_PAPER)
    return ImageReader(turned), turned.width / _PIXELS_PER_POINT, turned.height / _PIXELS_PER_POINT
