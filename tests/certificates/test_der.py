"""Distinguished encoding: what other libraries write is it, and every other way to write the same is not."""

from __future__ import annotations

import pytest
from asn1crypto import core
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat, PublicFormat
from hypothesis import given
from hypothesis import strategies as st

from ahrs_lab.certificates.der import is_distinguished, length_of, value


def encoded(text: str) -> bytes:
    return bytes.fromhex(text)


@given(
    st.integers(-(2**80), 2**80),
    st.booleans(),
    st.binary(max_size=300),
    st.lists(st.binary(max_size=5), max_size=6),
)
def test_what_another_library_writes_is_distinguished(
    number: int, flag: bool, octets: bytes, members: list[bytes]
) -> None:
    class Members(core.SetOf):  # type: ignore[misc]
        _child_spec = core.OctetString

    values = [
        core.Integer(number),
        core.Boolean(flag),
        core.OctetString(octets),
        core.Null(),
        core.ObjectIdentifier("1.2.840.113549.1.9.16.2.47"),
        Members([core.OctetString(one) for one in members]),
    ]
    for one in values:
        data = one.dump()
        assert is_distinguished(data)
        assert length_of(data + b"\x00\x01") == len(data)
        assert not is_distinguished(data + b"\x00")


def test_a_key_as_cryptography_writes_it_is_distinguished() -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    private = key.private_bytes(Encoding.DER, PrivateFormat.PKCS8, NoEncryption())
    public = key.public_key().public_bytes(Encoding.DER, PublicFormat.SubjectPublicKeyInfo)
    assert is_distinguished(private)
    assert is_distinguished(public)


@pytest.mark.parametrize(
    ("canonical", "other"),
    [
        ("0203010001", "02040001 0001"),  # a zero octet before the number
        ("0201ff", "0202ffff"),
        ("020180", "0202ff80"),
        ("0101ff", "010101"),  # true is 255
        ("0400", "048100"),  # a length in the long form that fits the short one
        ("0500", "050100"),  # a null with contents
        ("0603550403", "06045580 0403"),  # an empty septet in front
        ("06022a03", "06022a83"),  # the last number does not end
        ("0302 07 80", "0302 07 ff"),  # unused bits that are set
        ("0301 00", "0301 01"),  # unused bits of none
        ("3106 0401 01 0401 02", "3106 0401 02 0401 01"),  # a set out of order
        ("3003 0101 ff", "3080 0101 ff 0000"),  # indefinite length
        ("0403 616263", "2407 0401 61 0402 6263"),  # a string in pieces
        ("170d" + b"260101000000Z".hex(), "170b" + b"2601010000Z".hex()),
        ("180f" + b"20260101000000Z".hex(), "1811" + b"20260101000000.0Z".hex()),
        ("3003 020100", "3003 020200"),  # a value that goes beyond its container
        ("3000", "1000"),
    ],
)
def test_another_way_to_write_the_same_is_not(canonical: str, other: str) -> None:
    assert is_distinguished(encoded(canonical))
    assert not is_distinguished(encoded(other))


@given(st.binary(max_size=60))
def test_bytes_of_anybody_end(data: bytes) -> None:
    if is_distinguished(data):
        assert length_of(data) == len(data)


@given(st.lists(st.binary(max_size=200), max_size=4))
def test_a_value_is_made_as_another_library_makes_it(contents: list[bytes]) -> None:
    assert value(0x04, *contents) == core.OctetString(b"".join(contents)).dump()


def test_a_deep_nest_is_refused() -> None:
    data = b""
    for _ in range(100):
        data = b"\x30" + core.OctetString(data).dump()[1:]
    assert not is_distinguished(data)
