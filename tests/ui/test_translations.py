"""Every text of the screens has its Chinese, with the same values in it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PySide6.QtCore import QCoreApplication

import translations
from ahrs_lab.errors import MachineError
from ahrs_lab.messages import Message
from ahrs_lab.ui import translation
from ahrs_lab.ui.formatting import count, duration, number, signed_rate, wall_time_left
from ahrs_lab.ui.translation import language, said
from tests.ui.conftest import Look

PLACES = re.compile(r"\{(\w*)[^}]*\}")


def pairs(path: Path = translations.TEXTS) -> dict[tuple[str, str], str]:
    """(context, source) → translation."""
    root = ElementTree.parse(path).getroot()
    return {
        (context.findtext("name", ""), message.findtext("source", "")): message.findtext("translation", "")
        for context in root.iter("context")
        for message in context.iter("message")
    }


def test_no_text_is_left_without_chinese() -> None:
    assert translations.unfinished() == []


def test_file_holds_exactly_the_texts_of_the_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    copy = tmp_path / "ahrs_lab_zh.ts"
    shutil.copy(translations.TEXTS, copy)
    kept = pairs()
    monkeypatch.setattr(translations, "TEXTS", copy)
    translations.update()
    assert set(pairs(copy)) == set(kept), "run packaging/translations.py"


def test_values_are_the_same_in_both_languages() -> None:
    for (_, source), chinese in pairs().items():
        assert sorted(PLACES.findall(source)) == sorted(PLACES.findall(chinese)), source


def test_language_follows_the_switch(look: Look) -> None:
    message = Message("Stopped by the operator.")
    assert (language(), said(message)) == ("en", "Stopped by the operator.")
    look.language.set_language("zh")
    assert (language(), said(message)) == ("zh", "由校准员停止。")
    assert QCoreApplication.translate("StopBar", "STOP") == "停止"


def test_missing_translation_is_said_and_english_stays(look: Look, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(translation, "COMPILED", "translations/absent.qm")
    with pytest.raises(MachineError, match="cannot be read"):
        look.language.set_language("zh")
    assert language() == "en"


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (12345.6, 2, "12\u2009345.60"),
        (-0.5, 1, "−0.5"),
        (-0.00004, 4, "0.0000"),
        (None, 2, "–"),
        (float("nan"), 2, "–"),
        (-1234567.0, 0, "−1\u2009234\u2009567"),
    ],
)
def test_numbers_are_written_as_they_are_read(value: float | None, decimals: int, text: str) -> None:
    assert number(value, decimals) == text


def test_signs_counts_and_rates() -> None:
    assert number(0.25, 1, plus=True) == "+0.2"
    assert count(41200) == "41\u2009200"
    assert [signed_rate(rate) for rate in (-100.0, 0.5, 300.0)] == ["−100", "0.5", "300"]


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.0, "0 s"),
        (0.2, "1 s"),
        (24.0, "24 s"),
        (60.0, "1 min"),
        (3125.0, "52 min 05 s"),
        (3600.0, "1 h"),
        (3859.5, "1 h 05 min"),
        (4330.0, "1 h 13 min"),
        (7199.0, "2 h"),
        (None, "–"),
    ],
)
def test_durations_never_stand_at_zero_before_their_end(seconds: float | None, text: str) -> None:
    assert duration(seconds).replace("\u00a0", " ") == text


def test_short_durations_have_one_unit_below_an_hour() -> None:
    texts = [duration(seconds, short=True).replace("\u00a0", " ") for seconds in (73.0, 100.0, 3541.0)]
    assert texts == ["73 s", "2 min", "60 min"]


def test_wall_time_follows_the_bench_speed() -> None:
    left = wall_time_left(3600.0, 20.0)
    assert left is not None
    assert left.total_seconds() == 180.0
    assert wall_time_left(3600.0, None) is None
