"""Codecs of tables: any bytes in any split give the same answers and never an exception."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.errors import InputError
from ahrs_lab.instruments.protocols import actidyn, atl
from ahrs_lab.instruments.protocols.acutrol import (
    Call,
    Misunderstood,
    Reply,
    ReplyDecoder,
    bit_names,
    encode_reply,
    encode_request,
    parse_request,
)
from ahrs_lab.instruments.protocols.acutrol_responder import AclResponder
from ahrs_lab.instruments.protocols.lines import LineDecoder
from tests.instruments.fake_clock import FakeClock
from tests.instruments.tables.plant import Plant

DECODERS: list[Callable[[], Any]] = [
    ReplyDecoder,
    lambda: LineDecoder(b"\n", 12),
    lambda: LineDecoder(b"\r\n", 12),
    atl.AnswerDecoder,
]
PIECES = st.one_of(
    st.binary(max_size=12),
    st.builds(encode_reply, st.integers(-5, 300), st.text("0123456789.;-OK", max_size=20)),
    st.sampled_from([b"\r\n", b"\n", b">\r\n", b"12.5\r\n>\r\n", b"\r", b"PRV1 2,1.0,2.0\n"]),
)


@pytest.mark.parametrize("decoder", DECODERS)
@given(pieces=st.lists(PIECES, max_size=8), cuts=st.lists(st.integers(0, 200), max_size=12))
def test_any_bytes_in_any_split_give_the_same(
    decoder: Callable[[], Any], pieces: list[bytes], cuts: list[int]
) -> None:
    data = b"".join(pieces)
    whole, split = decoder(), decoder()
    wanted = whole.feed(data)
    got = []
    edges = sorted({min(cut, len(data)) for cut in cuts} | {0, len(data)})
    for start, stop in pairwise(edges):
        got += split.feed(data[start:stop])
    assert got == wanted
    whole.flush(), split.flush()
    assert split.counts == whole.counts
    assert split.counts.received_bytes == len(data)


@given(st.integers(-(10**6), 10**6), st.text(st.characters(min_codepoint=33, max_codepoint=126), max_size=60))
def test_an_acl_answer_survives_the_wire(code: int, text: str) -> None:
    decoder = ReplyDecoder()
    assert decoder.feed(encode_reply(code, text)) == [Reply(code, text)]


def test_an_acl_answer_is_two_little_endian_words_and_its_text() -> None:
    assert encode_reply(3, "OK") == bytes.fromhex("03000000 02000000 4f4b")
    assert encode_request(":Demand:Rate 1,-10") == b":Demand:Rate 1,-10\r\n"


def test_padding_of_an_acl_answer_is_stripped() -> None:
    padded = bytes.fromhex("00000000 06000000") + b"OK\r\n\0\0"
    assert ReplyDecoder().feed(padded) == [Reply(0, "OK")]


@given(st.binary(min_size=1, max_size=7))
def test_acl_answers_are_found_again_after_garbage(garbage: bytes) -> None:
    decoder = ReplyDecoder()
    # Garbage may look like a header that swallows an answer or two; not more than its plausible length.
    found = decoder.feed(b"\xff" + garbage + encode_reply(0, "12.5") * 1200)
    assert found[-1] == Reply(0, "12.5")
    assert len(found) >= 1200 - (8192 + 8) // 12 - 2


@pytest.mark.parametrize(
    ("line", "calls"),
    [
        (":D:P 1,10.5", [Call(("Demand", "Position"), False, ("1", "10.5"))]),
        ("demand:position 1,10.5", [Call(("Demand", "Position"), False, ("1", "10.5"))]),
        (
            ":Read:Pos? 1;Rate? 1;Acc? 1",
            [
                Call(("Read", "Position"), True, ("1",)),
                Call(("Read", "Rate"), True, ("1",)),
                Call(("Read", "Acceleration"), True, ("1",)),
            ],
        ),
        (
            ":Demand:Rate 1,0;:Mode:Rate 1",
            [Call(("Demand", "Rate"), False, ("1", "0")), Call(("Mode", "Rate"), False, ("1",))],
        ),
        ("*idn?", [Call(("*IDN",), True, ())]),
        (":Interlock? 1", [Call(("Interlock",), True, ("1",))]),
        (":I:C 1", [Call(("Interlock", "Close"), False, ("1",))]),
        (":Limit:Rate P, 1 ,120", [Call(("Limit", "Rate"), False, ("P", "1", "120"))]),
        (":Limit:A? 1", [Misunderstood("Limit:A? 1", "ambiguous command")]),
        (":Demand:Rate 1,0;Mode:Rate 1", [
            Call(("Demand", "Rate"), False, ("1", "0")), Misunderstood("Mode:Rate 1", "unknown command"),
        ]),
        (":Mode:Off? 1", [Misunderstood("Mode:Off? 1", "not a query")]),
        (":Read:Pos 1", [Misunderstood("Read:Pos 1", "not a command")]),
        (":Interlock 1", [Misunderstood("Interlock 1", "not a command")]),
        ("", []),
        (";;", []),
    ],
)  # fmt: skip
def test_requests_are_understood_as_the_language_says(line: str, calls: list[Call | Misunderstood]) -> None:
    assert parse_request(line) == calls


@given(st.text(st.characters(max_codepoint=255), max_size=40))
def test_any_request_gets_an_answer(line: str) -> None:
    responder = AclResponder(Plant(FakeClock()))
    code, text = responder.answer(line)
    assert text
    assert (code == 0) == (text not in responder.answer(f":Query:Error? {code}")[1] or code == 0)


@given(st.binary(max_size=60), st.integers(0, 60))
def test_the_responder_answers_each_line_once_whatever_the_split(data: bytes, cut: int) -> None:
    whole, split = (AclResponder(Plant(FakeClock())) for _ in range(2))
    assert split.feed(data[:cut]) + split.feed(data[cut:]) == whole.feed(data)
    assert len(ReplyDecoder().feed(whole.feed(b"*IDN?\r\n"))) >= 1


class TestResponder:
    """The table's side, as the language describes it."""

    def setup_method(self) -> None:
        self.clock = FakeClock()
        self.plant = Plant(self.clock)
        self.acl = AclResponder(self.plant)
        for line in (":Interlock:Reset 1", ":Interlock:Close 1"):
            assert self.acl.answer(line) == (0, "OK")

    def test_demands_persist_and_act_when_their_mode_is_entered(self) -> None:
        assert self.acl.answer(":Demand:Rate 1,50") == (0, "OK")
        self.clock.wait(2.0)
        assert self.plant.state().rate_dps == 0.0
        assert self.acl.answer(":Mode:Rate 1") == (0, "OK")
        self.clock.wait(2.0)
        assert self.plant.state().rate_dps == pytest.approx(50.0)
        self.acl.answer(":Demand:Rate 1,-20")
        self.clock.wait(2.0)
        assert self.plant.state().rate_dps == pytest.approx(-20.0)
        assert self.acl.answer(":Demand:Rate? 1") == (0, "-20")

    @pytest.mark.parametrize(("first", "second", "end"), [(170.0, -170.0, 190.0), (-100.0, 100.0, -260.0)])
    def test_a_position_is_reached_on_the_shortest_path_and_wraps(
        self, first: float, second: float, end: float
    ) -> None:
        for angle in (first, second):
            self.acl.answer(f":Demand:Position 1,{angle}")
            self.acl.answer(":Mode:Position 1")
            self.clock.wait(20.0)
        assert self.plant.state().angle_deg == pytest.approx(end)
        assert float(self.acl.answer(":Read:Pos? 1")[1]) == pytest.approx(second)

    def test_a_delta_is_half_a_turn_at_most(self) -> None:
        assert self.acl.answer(":Demand:DeltaPosition 1,181") == (203, "demand exceeds limit")
        assert self.acl.answer(":Demand:DeltaPosition 1,-45") == (0, "OK")
        assert self.acl.answer(":Demand:Position? 1") == (0, "-45")

    def test_nothing_moves_while_the_interlock_is_open(self) -> None:
        self.acl.answer(":Interlock:Open 1")
        assert self.acl.answer(":Mode:Rate 1") == (201, "interlock is open")
        assert self.acl.answer(":Interlock? 1") == (0, "Open")

    def test_a_fault_stays_latched_until_it_is_reset(self) -> None:
        self.acl.answer(":Mode:Rate 1")
        self.plant.fault = "drive tripped"
        assert self.acl.answer(":Interlock? 1") == (0, "Fault")
        assert int(self.acl.answer(":Status:STB? 1")[1]) & 0b1000011 == 0b1000011
        assert self.acl.answer(":Interlock:Close 1")[0] == 202
        self.acl.answer(":Interlock:Reset 1")
        assert self.acl.answer(":Interlock:Close 1") == (0, "OK")
        assert self.acl.answer(":Interlock? 1") == (0, "Close")
        latched = int(self.acl.answer(":Status:ESR? A1SWFLT")[1])
        assert latched == 0

    def test_the_status_byte_clears_on_one_way_of_reading_only(self) -> None:
        self.acl.answer(":Nonsense")
        for _ in range(2):
            assert int(self.acl.answer(":Status:STB? 1")[1]) & 1 << 7
        assert int(self.acl.answer("*STB?")[1]) & 1 << 7
        assert int(self.acl.answer("*STB?")[1]) == 0

    def test_all_axes_is_for_commands_only(self) -> None:
        assert self.acl.answer(":Mode:Off ALL") == (0, "OK")
        assert self.acl.answer(":Mode? ALL") == (106, "no such axis")
        assert self.acl.answer(":Mode:Off 2") == (106, "no such axis")

    def test_bits_have_names(self) -> None:
        assert bit_names("SWFLT", 0b110) == ("rate trip", "tracking error")
        assert bit_names("STATE", 1 << 20) == ("bit 20",)


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("PRV1 2,12.5,-3", (12.5, -3.0)),
        ("PRV 2, 12.5 , -3\r", (12.5, -3.0)),
        ("PRV2,12.5", None),
        ("PRV,12.5", None),
        ("PRV 1,x", None),
        ("PRV 1,nan", None),
        ("", None),
        ("9" * 5000 + ",1", None),
    ],
)
def test_actidyn_answers_tell_how_many_values_they_have(line: str, values: tuple[float, ...] | None) -> None:
    assert actidyn.parse_values(line) == values


@given(st.text(max_size=30))
def test_no_line_upsets_actidyn(line: str) -> None:
    actidyn.parse_values(line)


def test_atl_answers_end_with_the_prompt() -> None:
    decoder = atl.AnswerDecoder()
    assert decoder.feed(b"12.5\r\n>\r\n>\r\n7\r\n") == [("12.5",), ()]
    assert decoder.feed(atl.encode_answer("8")) == [("7", "8")]
    assert atl.encode_command("MOV", 12.5) == b"MOV 12.5\r\n"
    assert atl.encode_command("STO") == b"STO\r\n"


def test_unknown_placeholders_of_a_language_are_refused() -> None:
    from ahrs_lab.instruments.drivers.tables.ascii_table import template_examples, template_from_text

    text = template_examples()["example-servo"]
    assert template_from_text(text, "x").render("rate", rate_dps=-12.5) == ("JOG -12.5000",)
    for wrong in (
        text.replace("{rate:.4f}", "{speed}"),
        text.replace("{rate:.4f}", "{rate.real}"),
        text.replace("{rate:.4f}", "{rate:d}"),
        text.replace("{rate:.4f}", "{"),
        text.replace("(?P<angle>", "("),
        text.replace("(?P<angle>", "((?P<angle>"),
        text.replace('stop = ["STOP"]', "stop = []"),
        text.replace('query = "POS?"', "query = 5"),
        text.replace("angle_deg = 1.0", "angle_deg = 0"),
        text.replace("[timing]", "[timeing]"),
    ):
        assert wrong != text
        with pytest.raises(InputError):
            template_from_text(wrong, "x")
