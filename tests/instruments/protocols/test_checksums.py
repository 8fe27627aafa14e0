"""Checksums against their published check values, and rows against single messages."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.instruments.protocols.checksums import CHECKSUMS

CHECK = b"123456789"


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("crc16-xmodem", 0x31C3),
        ("crc16-ccitt", 0x29B1),
        ("crc16-modbus", 0x4B37),
        ("crc32", 0xCBF43926),
        ("sum8", 0xDD),
        ("sum16", 0x01DD),
        ("xor", 0x31),
    ],
)
def test_published_check_values(kind: str, value: int) -> None:
    assert CHECKSUMS[kind].of(CHECK) == value  # type: ignore[index]


def test_fletcher_is_that_of_the_manufacturer_s_packet() -> None:
    assert CHECKSUMS["fletcher"].of(bytes.fromhex("756501020201")) == int.from_bytes(b"\xe0\xc6", "big")
    assert CHECKSUMS["fletcher"].of(bytes.fromhex("75650100")) == 0xDB05


@pytest.mark.parametrize("kind", list(CHECKSUMS))
@given(data=st.binary(min_size=0, max_size=300), count=st.integers(1, 5))
def test_rows_are_checked_like_single_messages(kind: str, data: bytes, count: int) -> None:
    checksum = CHECKSUMS[kind]  # type: ignore[index]
    length = len(data) // count
    if not length:
        return
    rows = np.frombuffer(data, np.uint8, length * count).reshape(count, length)
    assert checksum.of_rows(rows).tolist() == [checksum.of(row.tobytes()) for row in rows]
