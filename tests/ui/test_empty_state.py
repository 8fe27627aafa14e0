"""The empty page on a small screen."""

from __future__ import annotations

from pytestqt.qtbot import QtBot

from ahrs_lab.ui.widgets.empty_state import EmptyState


def test_its_sentence_is_wrapped_into_the_room_there_is(qtbot: QtBot) -> None:
    state = EmptyState("results")
    qtbot.addWidget(state)
    state.set_content("Nothing", "A sentence that is much longer than a narrow card is wide. " * 3, "Go on")
    state.resize(240, 500)
    state.show()
    narrow = state._text.geometry()
    assert state.rect().contains(narrow)
    state.resize(900, 500)
    assert 240 < state._text.width() <= 420
    assert state._text.height() < narrow.height()
