"""Navigation of recordings: the truth comes back, and what is wrong with a recording is said."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from numpy.typing import NDArray

from ahrs_lab.analysis.navigation import navigate_recording
from ahrs_lab.analysis.navigation_result import NavigationResult
from ahrs_lab.errors import InputError
from ahrs_lab.inertial.sensor_model import AccelModel
from ahrs_lab.recording.read import read_bundle
from ahrs_lab.simulation.manoeuvres import Accelerate, Steady, Turn
from ahrs_lab.simulation.settings import SensorSettings
from ahrs_lab.simulation.trajectory import Flight, Start, fly
from ahrs_lab.simulation.trajectory_recording import write_flight

Array = NDArray[np.float64]
Edit = Callable[[list[str]], list[str]]
START = Start(heading_deg=350.0, pitch_deg=1.0, roll_deg=2.0)


@pytest.fixture(scope="module")
def flight() -> Flight:
    """Through north, 40 s at 50 Hz."""
    return fly(START, (Steady(5.0), Accelerate(10.0, 30.0), Turn(20.0, 60.0), Steady(5.0)), 50.0)


def navigated(folder: Path, damping: str = "none") -> NavigationResult:
    return navigate_recording(read_bundle(folder), damping)  # type: ignore[arg-type]


def written(folder: Path, flight: Flight, edit: Edit, *, reference: bool = False) -> Path:
    """The flight as CSV, its lines edited."""
    write_flight(folder, flight, file_format="csv", reference=reference)
    file = folder / "segments" / "dynamic.csv"
    file.write_text(
        "".join(edit(file.read_text(encoding="utf-8").splitlines(keepends=True))), encoding="utf-8"
    )
    return folder


def test_the_flight_comes_back(tmp_path: Path, flight: Flight) -> None:
    result = navigated(write_flight(tmp_path / "a", flight, reference=True))
    final = result.to_json()["final"]
    assert set(final) == {
        "t_s",
        "heading_deg",
        "pitch_deg",
        "roll_deg",
        "velocity_enu_mps",
        "latitude_deg",
        "longitude_deg",
        "altitude_m",
    }
    assert final["t_s"] == 40.0
    assert final["heading_deg"] == pytest.approx(50.0, abs=1e-6)
    assert final["velocity_enu_mps"] == pytest.approx(flight.velocity_enu_mps[-1], abs=1e-6)
    assert final["latitude_deg"] == pytest.approx(np.degrees(flight.latitude_rad[-1]), abs=1e-10)
    assert len(result.errors) == 9
    for values in result.errors.values():
        assert np.max(np.abs(values)) < 2e-3
    assert result.warnings == ()
    titles = [chart.title.text() for chart in result.report().charts]
    assert titles[:4] == ["Attitude", "Velocity", "Track", "Height"]
    assert titles[4:] == ["Error of attitude", "Error of velocity", "Error of position"]
    # the drawn heading goes through north without a jump
    assert np.max(np.abs(np.diff(result.report().charts[0].curves[0].y))) < 1.0


def test_without_reference_columns_there_are_no_errors(tmp_path: Path, flight: Flight) -> None:
    result = navigated(write_flight(tmp_path / "a", flight))
    assert result.errors == {}
    assert len(result.report().charts) == 4


def test_errors_are_navigation_minus_reference(tmp_path: Path) -> None:
    """An accelerometer that shows 10 mm/s² too much north, over 20 s at rest."""
    rest = fly(Start(), (Steady(20.0),), 50.0)
    sensors = SensorSettings(accel=AccelModel(bias_mps2=(0.0, 0.01, 0.0)))
    result = navigated(write_flight(tmp_path / "a", rest, sensors, reference=True))
    assert result.errors["error_vn_mps"][-1] == pytest.approx(0.2, rel=1e-3)
    assert result.errors["error_north_m"][-1] == pytest.approx(2.0, rel=1e-3)
    assert abs(result.errors["error_east_m"][-1]) < 0.01


def test_baro_follows_the_recorded_height_or_the_initial_one(tmp_path: Path) -> None:
    rest = fly(Start(altitude_m=50.0), (Steady(400.0),), 10.0)
    heavy = SensorSettings(accel=AccelModel(bias_mps2=(0.0, 0.0, 0.001)))
    free = navigated(write_flight(tmp_path / "a", rest, heavy))
    assert free.series["altitude_m"][-1] > 120.0
    held = navigated(tmp_path / "a", "baro")
    # the loop leaves bias/k₂
    assert held.series["altitude_m"][-1] == pytest.approx(50.0 + 0.001 / 0.00111, abs=0.02)
    assert "initial height" in held.notes[0].text()
    with_column = navigated(write_flight(tmp_path / "b", rest, heavy, reference=True), "baro")
    assert with_column.series["altitude_m"] == pytest.approx(held.series["altitude_m"], abs=1e-6)
    assert "follows the column" in with_column.notes[0].text()


def test_an_undamped_height_of_long_records_is_warned_of(tmp_path: Path) -> None:
    rest = fly(Start(), (Steady(700.0),), 1.0)
    result = navigated(write_flight(tmp_path / "a", rest))
    assert "height is not held" in result.warnings[-1].text()
    assert navigated(tmp_path / "a", "baro").warnings == ()


def test_a_short_gap_is_bridged_and_said(tmp_path: Path, flight: Flight) -> None:
    def edit(lines: list[str]) -> list[str]:
        return lines[:101] + lines[111:]

    result = navigated(written(tmp_path / "a", flight, edit))
    assert any("10 samples are missing" in w.text() for w in result.warnings)
    assert any("1 gaps, 0.2 s together, are bridged" in w.text() for w in result.warnings)
    # at rest the mean of the row after is right
    assert result.series["heading_deg"][-1] == pytest.approx(50.0, abs=1e-4)


def test_a_long_gap_is_refused_where_it_is(tmp_path: Path, flight: Flight) -> None:
    folder = written(tmp_path / "a", flight, lambda lines: lines[:501] + lines[601:])
    with pytest.raises(InputError, match=r"dynamic\.csv: a gap of 2 s after 10 s is too long"):
        navigated(folder)


def test_rows_without_numbers_and_backward_times_are_left_out(tmp_path: Path, flight: Flight) -> None:
    def edit(lines: list[str]) -> list[str]:
        lines[50] = ",".join([*lines[50].split(",")[:6], "nan\n"])
        lines[60] = ",".join([lines[60].split(",")[0], "oops", *lines[60].split(",")[2:]])
        lines[70], lines[71] = lines[71], lines[70]
        return lines

    result = navigated(written(tmp_path / "a", flight, edit))
    said = " ".join(w.text() for w in result.warnings)
    assert "1 rows without numbers of all accelerometers" in said
    assert "oops" in said
    assert "backward" in said
    assert np.all(np.isfinite(result.series["heading_deg"]))
    assert result.series["heading_deg"][-1] == pytest.approx(50.0, abs=1e-4)


def test_accelerometers_without_any_number_are_said(tmp_path: Path, flight: Flight) -> None:
    def edit(lines: list[str]) -> list[str]:
        return [lines[0], *(",".join([*line.split(",")[:6], "nan\n"]) for line in lines[1:])]

    with pytest.raises(InputError, match="not one row"):
        navigated(written(tmp_path / "a", flight, edit))


def test_one_row_is_navigated(tmp_path: Path, flight: Flight) -> None:
    result = navigated(written(tmp_path / "a", flight, lambda lines: lines[:2]))
    assert len(result.t_s) == 1
    assert result.series["heading_deg"] == pytest.approx([350.0], abs=1e-6)


def test_no_row_is_said(tmp_path: Path, flight: Flight) -> None:
    with pytest.raises(InputError):
        navigated(written(tmp_path / "a", flight, lambda lines: lines[:1]))


def split_flight(folder: Path, flight: Flight, second_from: int) -> Path:
    """The flight in two segments, the second beginning at a row."""
    write_flight(folder, flight, file_format="csv")
    lines = (folder / "segments" / "dynamic.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / "segments" / "dynamic.csv").write_text("".join(lines[:1001]), encoding="utf-8")
    rest = "".join([lines[0], *lines[second_from + 1 :]])
    (folder / "segments" / "more.csv").write_text(rest, encoding="utf-8")
    header = folder / "recording.toml"
    text = header.read_text(encoding="utf-8")
    table = text[text.index("[[segment]]") :]
    header.write_text(text + "\n" + table.replace("dynamic.csv", "more.csv"), encoding="utf-8")
    return folder


def test_segments_that_follow_each_other_are_one_record(tmp_path: Path, flight: Flight) -> None:
    whole = navigated(write_flight(tmp_path / "a", flight))
    both = navigated(split_flight(tmp_path / "b", flight, 1000))
    assert both.files == ("segments/dynamic.csv", "segments/more.csv")
    assert both.to_json()["final"]["latitude_deg"] == pytest.approx(
        whole.to_json()["final"]["latitude_deg"], abs=1e-12
    )


def test_navigation_ends_where_the_next_segment_does_not_follow(tmp_path: Path, flight: Flight) -> None:
    result = navigated(split_flight(tmp_path / "a", flight, 1100))
    assert result.t_s[-1] == 20.0
    assert "does not go on" in result.warnings[-1].text()


def test_without_initial_state_it_is_said_what_to_write(tmp_path: Path, flight: Flight) -> None:
    with pytest.raises(InputError, match=r"no \[initial\].*heading_deg"):
        navigated(write_flight(tmp_path / "a", flight, initial=False))


@pytest.mark.parametrize(
    ("table", "key", "value", "said"),
    [
        ("initial", "heading_deg", None, "heading_deg” is missing"),
        ("initial", "heading_deg", float("nan"), "heading_deg” is nan"),
        ("initial", "heading_deg", "north", "heading_deg” is 'north'"),
        ("initial", "pitch_deg", 91.0, "between -90.0 and 90.0"),
        ("initial", "velocity_enu_mps", [0.0, 0.0], "write three numbers"),
        ("initial", "velocity_enu_mps", [0.0, 0.0, float("nan")], "write three numbers"),
        ("initial", "velocity_enu_mps", None, "velocity_enu_mps” is missing"),
        ("initial", "latitude_deg", 90.0, "east and north are lost"),
        ("device", "rate_unit", "LSB", "compensate"),
        ("device", "accel_unit", "g", r"look like m/s\^2"),
    ],
)
def test_what_is_wrong_with_the_header_is_said(
    tmp_path: Path, flight: Flight, table: str, key: str, value: object, said: str
) -> None:
    header = write_flight(tmp_path / "a", flight) / "recording.toml"
    document = tomllib.loads(header.read_text(encoding="utf-8"))
    del document[table][key]
    if value is not None:
        document[table][key] = value
    header.write_text(tomli_w.dumps(document), encoding="utf-8")
    with pytest.raises(InputError, match=said):
        navigated(tmp_path / "a")


def test_a_wrong_sample_rate_in_the_header_makes_no_gaps(tmp_path: Path, flight: Flight) -> None:
    header = write_flight(tmp_path / "a", flight) / "recording.toml"
    text = header.read_text(encoding="utf-8")
    header.write_text(text.replace("sample_rate_hz = 50.0", "sample_rate_hz = 100.0"), encoding="utf-8")
    result = navigated(tmp_path / "a")
    assert any("correct sample_rate_hz" in w.text() for w in result.warnings)
    assert not any("bridged" in w.text() for w in result.warnings)
    assert result.series["heading_deg"][-1] == pytest.approx(50.0, abs=1e-6)


def test_the_place_may_stand_with_the_site(tmp_path: Path, flight: Flight) -> None:
    whole = navigated(write_flight(tmp_path / "a", flight)).to_json()
    header = tmp_path / "a" / "recording.toml"
    document = tomllib.loads(header.read_text(encoding="utf-8"))
    for key in ("latitude_deg", "longitude_deg", "altitude_m"):
        del document["initial"][key]
    header.write_text(tomli_w.dumps(document), encoding="utf-8")
    assert navigated(tmp_path / "a").to_json() == whole


def test_a_recording_without_accelerometers_is_refused(tmp_path: Path, flight: Flight) -> None:
    def edit(lines: list[str]) -> list[str]:
        return [",".join(line.split(",")[:4]).rstrip() + "\n" for line in lines]

    with pytest.raises(InputError, match="no accelerometer columns"):
        navigated(written(tmp_path / "a", flight, edit))
