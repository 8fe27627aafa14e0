"""The drawing's geometry against what the eye has to see."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from ahrs_lab.recording.orientation import AXES, Orientation, all_orientations
from ahrs_lab.ui import case_scene
from ahrs_lab.ui.case_drawing import CaseDrawing
from ahrs_lab.ui.theme import AXIS_COLOURS
from tests.ui.conftest import Look


@pytest.mark.parametrize("orientation", all_orientations(), ids=str)
def test_each_axis_arrow_points_where_the_orientation_says(orientation: Orientation) -> None:
    compass = case_scene.compass()
    words = dict(zip("ENU", ("east", "north", "up"), strict=True))
    opposite = dict(zip("WSD", "ENU", strict=True))
    drawn = case_scene.scene(case_scene.seat(orientation), 0.0, 0.0)
    for arrow in drawn.arrows:
        letter = orientation.letters[AXES.index(arrow.axis)]
        sign = -1.0 if letter in opposite else 1.0
        name = words[opposite.get(letter, letter)]
        direction = arrow.tip - arrow.start
        wanted = sign * compass[name]
        cosine = direction @ wanted / np.linalg.norm(direction) / np.linalg.norm(wanted)
        assert cosine == pytest.approx(1.0)


def test_compass_is_seen_as_on_a_map_from_the_south_east() -> None:
    compass = case_scene.compass()
    assert compass["up"][0] == pytest.approx(0.0)
    assert compass["up"][1] < 0, "the screen's y goes down"
    assert compass["north"][0] > 0 > compass["north"][1], "away from the viewer: up on the screen"
    assert compass["east"][0] > 0
    assert compass["east"][1] > 0, "toward the viewer"


def test_table_angle_turns_by_the_right_hand() -> None:
    still = case_scene.scene(np.eye(3), 0.0, 0.0).arrows[0]
    turned = case_scene.scene(np.eye(3), 0.0, 90.0).arrows[0]
    north = case_scene.compass()["north"]
    direction = turned.tip - turned.start
    assert direction[0] * north[1] - direction[1] * north[0] == pytest.approx(0.0)
    assert direction @ north > 0
    assert not np.allclose(still.tip, turned.tip)


@pytest.mark.parametrize("end", all_orientations(), ids=str)
def test_turn_goes_from_one_orientation_to_the_other_through_rotations(end: Orientation) -> None:
    start = Orientation("UEN")
    a, b = case_scene.seat(start), case_scene.seat(end)
    np.testing.assert_allclose(case_scene.between(a, b, 0.0), a, atol=1e-12)
    np.testing.assert_allclose(case_scene.between(a, b, 1.0), b, atol=1e-12)
    half = case_scene.between(a, b, 0.5)
    np.testing.assert_allclose(half @ half.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(half) == pytest.approx(1.0)
    np.testing.assert_allclose(half @ a.T @ half, b, atol=1e-12)


@pytest.mark.parametrize("orientation", all_orientations(), ids=str)
def test_case_stands_on_the_plate_and_not_in_it(orientation: Orientation) -> None:
    facets = case_scene.scene(case_scene.seat(orientation), 0.0, 0.0).facets
    assert {"case", "fixture"} <= {facet.material for facet in facets}
    assert sum(facet.material == "case" for facet in facets) == 3, "three faces of a box are seen"


def test_all_three_axes_are_painted_in_their_colours(look: Look, qtbot: QtBot) -> None:
    drawing = CaseDrawing()
    qtbot.addWidget(drawing)
    drawing.resize(420, 300)
    drawing.show_still(Orientation("ENU"))
    drawing.show()
    look.settle()
    picture = drawing.grab().toImage()
    seen = {
        QColor(picture.pixel(x, y)).name().upper()
        for x in range(picture.width())
        for y in range(picture.height())
    }
    # North points away from the viewer: its arrow is seen through the case, its letter in full colour.
    assert {colour.upper() for colour in AXIS_COLOURS.values()} <= seen


def test_turn_is_played_only_while_it_is_seen(look: Look, qtbot: QtBot) -> None:
    drawing = CaseDrawing()
    qtbot.addWidget(drawing)

    def moving() -> bool:
        return drawing.moving

    drawing.show_turn(Orientation("NUE"), Orientation("UEN"))
    assert not moving()
    drawing.show()
    assert moving()
    drawing.hide()
    assert not moving()
    drawing.show()
    drawing.show_still(Orientation("NUE"))
    assert not moving()
