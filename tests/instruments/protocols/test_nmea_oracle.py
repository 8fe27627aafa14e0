"""Sentences of heading and attitude are read as pynmeagps reads them, the usual and the odd ones."""

from __future__ import annotations

import math
from datetime import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pynmeagps import NMEAReader  # type: ignore[import-untyped]

from ahrs_lab.instruments.protocols import nmea
from ahrs_lab.instruments.protocols.catalogue import stream_decoder

HEADING = {"heading_deg": "headingT"}
ATTITUDE = {"heading_deg": "trueHdg", "pitch_deg": "pitch", "roll_deg": "roll"}

numbers = st.from_regex(r"[+-]?[0-9]{1,4}(\.[0-9]{0,4})?", fullmatch=True)
clocks = st.from_regex(r"[0-2][0-9][0-5][0-9][0-6][0-9](\.[0-9]{0,7})?", fullmatch=True)
integers = st.sampled_from(["1", "0", "", "07"])
words = st.sampled_from(["T", "", "M", "+0.10", "free text"])
ODD_NUMBERS = (
    "",
    "-",
    "+.5",
    "1.",
    "1e3",
    "1_0",
    " 2",
    "nan",
    "-inf",
    "0x1",
    "1.2.3",
    "9" * 20,
    "T",
    "+1",
    "1",
)
ODD_CLOCKS = ("85335.0", "0853351", "240000", "235960.5", "08533 .1", "T85335", "085335.")
odd = st.sampled_from(ODD_NUMBERS + ODD_CLOCKS)


@st.composite
def sentences(draw: st.DrawFn, addresses: list[str], usual: st.SearchStrategy[tuple[str, ...]]) -> bytes:
    """Often as makers print it; else with odd fields, fewer or more of them."""
    fields = list(draw(usual))
    for place in draw(st.lists(st.integers(0, len(fields) - 1), max_size=2)):
        fields[place] = draw(odd)
    kept = draw(st.one_of(st.just(len(fields)), st.integers(0, len(fields))))
    more = draw(st.one_of(st.just([]), st.lists(words, max_size=2)))
    address = draw(st.one_of(st.just(addresses[0]), st.sampled_from(addresses)))
    return nmea.encode(address, *fields[:kept], *more)


HEADINGS = sentences(
    ["HEHDT", "GPHDT", "PHDT", "XXHDT", "HDT", "aaHDT", "HEHDM", "1HHDT", "PAHDT"], st.tuples(numbers, words)
)
ATTITUDES = sentences(
    ["PASHR", "GPASHR", "PASHRX", "PASHHDT"],
    st.tuples(clocks, numbers, words, *[numbers] * 2, words, *[numbers] * 3, *[integers] * 2),
)


def oracle(line: bytes) -> dict[str, float] | None:
    """What pynmeagps reads; None where it is no row."""
    address = line[1:].split(b",")[0].split(b"*")[0]
    wanted = ATTITUDE if address == b"PASHR" else HEADING if address.endswith(b"HDT") else None
    if wanted is None or b"," not in line:
        return None
    try:
        message = NMEAReader.parse(line, validate=0)
    except Exception:
        return None
    row = {name: getattr(message, attribute, None) for name, attribute in wanted.items()}
    if not all(isinstance(value, float) for value in row.values()):
        return None
    clock = getattr(message, "utctime", None)
    if isinstance(clock, time):
        row["t_s"] = ((clock.hour * 60 + clock.minute) * 60 + clock.second) + clock.microsecond / 1e6
    return {name: float(value) for name, value in row.items() if value is not None}


@pytest.mark.parametrize("kind", [HEADINGS, ATTITUDES], ids=["heading", "attitude"])
@settings(max_examples=300)
@given(data=st.data())
def test_a_sentence_is_read_as_pynmeagps_reads_it(
    kind: st.SearchStrategy[bytes], data: st.DataObject
) -> None:
    line = data.draw(kind)
    decoder = stream_decoder("nmea")
    rows = [*decoder.feed(line + line[:8]).columns.items(), *decoder.flush().columns.items()]
    expected = oracle(line)
    if expected is None:
        assert rows == []
        assert decoder.replies == [nmea.sentence_of(line)]
        return
    assert decoder.replies == []
    assert {name: column.tolist() for name, column in rows} == {
        name: [pytest.approx(value, rel=0, abs=1e-9 if name == "t_s" else 0)]
        for name, value in expected.items()
        if not math.isnan(value)
    }


def test_the_usual_sentences_do_without_pynmeagps(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bytes] = []
    monkeypatch.setattr(nmea, "_parsed", asked.append)
    decoder = stream_decoder("nmea")
    decoder.feed(b"$PASHR,085335.000,224.19,T,-01.26,+00.83,+00.10,0.101,0.113,0.267,1,0*07\r\n")
    decoder.feed(nmea.encode("PASHR", "085335", "224", "T", "-1", "+0.", "", "", "", "", "") * 2)
    decoder.feed(b"$HEHDT,274.07,T*19\r\n")
    assert asked == []
    decoder.feed(nmea.encode("HEHDT", "2e1", "T"))
    assert len(asked) == 1
