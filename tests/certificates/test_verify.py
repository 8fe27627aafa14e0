"""What verification finds: a changed byte, a change by a later update, an appended file, and no signature."""

from __future__ import annotations

import io
import json
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pikepdf
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyhanko.pdf_utils import generic as untyped_generic
from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
from pyhanko.sign.validation import DocumentSecurityStore

from ahrs_lab.certificates import verify
from ahrs_lab.certificates.authority import Authority
from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.der import SEQUENCE, SET, length_of, value
from ahrs_lab.certificates.layout import Role
from ahrs_lab.certificates.signing import sign_certificate
from ahrs_lab.certificates.verify import verify_pdf
from ahrs_lab.errors import InputError
from tests.certificates.conftest import sample_job, sample_result

generic: Any = untyped_generic
ROLES: tuple[Role, ...] = ("operator", "verifier", "approver")


@pytest.fixture(scope="module")
def authority(tmp_path_factory: pytest.TempPathFactory) -> Authority:
    made = Authority(tmp_path_factory.mktemp("authority"))
    for role in ROLES:
        made.issue(role, f"Demo {role}", "password")
    return made


@pytest.fixture(scope="module")
def versions(tmp_path_factory: pytest.TempPathFactory, authority: Authority) -> dict[str, bytes]:
    """The certificate unsigned, and after each signature."""
    path = tmp_path_factory.mktemp("signed") / "certificate.pdf"
    job = sample_job()
    certificate_pdf(sample_result(), job, path)
    found = {"unsigned": path.read_bytes()}
    for role in ROLES:
        sign_certificate(path, role, authority.unlock(role, "password"), getattr(job, role))
        found[role] = path.read_bytes()
    return found


@pytest.fixture(scope="module")
def signed(versions: dict[str, bytes]) -> bytes:
    return versions["approver"]


def put(tmp_path: Path, data: bytes) -> Path:
    path = tmp_path / "certificate.pdf"
    path.write_bytes(data)
    return path


def test_the_untouched_file_is_valid(tmp_path: Path, signed: bytes, authority: Authority) -> None:
    report = verify_pdf(put(tmp_path, signed), authority.trust_roots)
    assert report.valid
    assert report.text().startswith("Intact and unchanged since it was signed by Demo operator")
    assert report.text("zh").startswith("完整，自 Demo operator")
    assert "  校准员: Demo operator (Demonstration), 20" in report.text("zh")
    data = json.loads(json.dumps(report.to_json()))
    assert data["valid"] is True
    assert [one["role"] for one in data["signatures"]] == list(ROLES)


def test_a_changed_byte_anywhere_is_found(tmp_path: Path, signed: bytes, authority: Authority) -> None:
    chance = random.Random(20261122)
    for place in chance.sample(range(len(signed)), 40):
        data = bytearray(signed)
        data[place] ^= 1 << chance.randrange(8)
        report = verify_pdf(put(tmp_path, bytes(data)), authority.trust_roots)
        assert not report.valid, f"byte {place}"


def test_a_changed_byte_inside_the_last_signature_itself_is_found(
    tmp_path: Path, signed: bytes, authority: Authority
) -> None:
    first, second = (int(v) for v in re.findall(rb"/ByteRange \[0 (\d+) (\d+)", signed)[-1])
    used = len(signed[first + 1 : second - 1].rstrip(b"0"))
    chance = random.Random(5)
    places = [*chance.sample(range(first, first + used), 25), second - 2, second - 1, first]
    for place in places:
        data = bytearray(signed)
        data[place] = ord("0123456789abcdef"[(int(chr(data[place]), 16) + 1) % 16]) if chr(
            data[place]
        ).isalnum() else ord("!")  # fmt: skip
        assert not verify_pdf(put(tmp_path, bytes(data)), authority.trust_roots).valid, f"byte {place}"


def changed_page(data: bytes) -> bytes:
    """Another text on the first page, by an incremental update with everything in order."""
    writer: Any = IncrementalPdfFileWriter(io.BytesIO(data))
    page = writer.root["/Pages"]["/Kids"][0]
    content = writer.add_object(generic.StreamObject(stream_data=b"BT /F1 12 Tf 72 400 Td (K = 2) Tj ET"))
    page["/Contents"] = generic.ArrayObject([page.raw_get("/Contents"), content])
    writer.update_container(page)
    out = io.BytesIO()
    writer.write(out)
    return out.getvalue()


@pytest.mark.parametrize("stage", ROLES)
def test_a_page_changed_by_a_later_update_is_found(
    tmp_path: Path, versions: dict[str, bytes], authority: Authority, stage: Role
) -> None:
    report = verify_pdf(put(tmp_path, changed_page(versions[stage])), authority.trust_roots)
    assert not report.valid
    assert not report.intact
    assert report.signatures[-1].intact, "the signed bytes themselves are untouched"
    assert report.signatures[-1].modification == "forbidden"
    assert not report.signatures[-1].covers_whole
    assert report.changed_since is not None
    assert "changed after" in report.changed_since.text()


def test_an_annotation_over_a_number_is_found(tmp_path: Path, signed: bytes, authority: Authority) -> None:
    writer: Any = IncrementalPdfFileWriter(io.BytesIO(signed))
    note = generic.DictionaryObject(
        {
            generic.pdf_name("/Type"): generic.pdf_name("/Annot"),
            generic.pdf_name("/Subtype"): generic.pdf_name("/FreeText"),
            generic.pdf_name("/Contents"): generic.pdf_string("1.000 00"),
            generic.pdf_name("/Rect"): generic.ArrayObject(
                [generic.NumberObject(v) for v in (10, 10, 90, 30)]
            ),
        }
    )
    page = writer.root["/Pages"]["/Kids"][1]
    page["/Annots"] = generic.ArrayObject([writer.add_object(note)])
    writer.update_container(page)
    out = io.BytesIO()
    writer.write(out)
    assert not verify_pdf(put(tmp_path, out.getvalue()), authority.trust_roots).valid


@pytest.mark.parametrize("tail", [b"x", b"\n", b"\n%%EOF\n", b" " * 5000, b"%PDF-1.7"])
def test_bytes_appended_after_the_last_signature_are_found(
    tmp_path: Path, signed: bytes, authority: Authority, tail: bytes
) -> None:
    assert not verify_pdf(put(tmp_path, signed + tail), authority.trust_roots).valid


def test_an_empty_update_after_the_last_signature_is_found(
    tmp_path: Path, signed: bytes, authority: Authority
) -> None:
    writer: Any = IncrementalPdfFileWriter(io.BytesIO(signed))
    writer.root[generic.pdf_name("/PageLayout")] = generic.pdf_name("/OneColumn")
    writer.update_root()
    out = io.BytesIO()
    writer.write(out)
    assert not verify_pdf(put(tmp_path, out.getvalue()), authority.trust_roots).valid


def updated(signed: bytes, change: Callable[[Any], None]) -> bytes:
    """An incremental update with everything in order."""
    writer: Any = IncrementalPdfFileWriter(io.BytesIO(signed))
    change(writer)
    out = io.BytesIO()
    writer.write(out)
    return out.getvalue()


def another_title(writer: Any) -> None:
    title = generic.pdf_string("Another certificate")
    writer.set_info(writer.add_object(generic.DictionaryObject({generic.pdf_name("/Title"): title})))


def another_metadata(writer: Any) -> None:
    writer._update_meta = lambda: None  # else pyHanko writes what it thinks right
    said = writer.root["/Metadata"].data
    changed = said.replace(b"rdf:li>", b"rdf:li>Another ", 1)
    assert changed != said
    stream = generic.StreamObject({}, stream_data=changed)
    stream.update({generic.pdf_name("/Type"): generic.pdf_name("/Metadata"),
                   generic.pdf_name("/Subtype"): generic.pdf_name("/XML")})  # fmt: skip
    writer.root[generic.pdf_name("/Metadata")] = writer.add_object(stream)
    writer.update_root()


@pytest.mark.parametrize("change", [another_title, another_metadata])
def test_a_title_or_metadata_changed_after_the_last_signature_is_found(
    tmp_path: Path, signed: bytes, authority: Authority, change: Callable[[Any], None]
) -> None:
    data = updated(signed, change)
    assert data.startswith(signed)
    report = verify_pdf(put(tmp_path, data), authority.trust_roots)
    assert not report.valid
    assert report.changed_since is not None


def test_validation_data_after_the_last_signature_change_nothing(
    tmp_path: Path, signed: bytes, authority: Authority
) -> None:
    out = io.BytesIO(signed)
    stranger = Authority(tmp_path / "stranger")
    stranger.create()
    DocumentSecurityStore.add_dss(out, None, certs=verify._certificates(stranger.trust_roots))
    assert len(out.getvalue()) > len(signed)
    assert verify_pdf(put(tmp_path, out.getvalue()), authority.trust_roots).valid


def test_going_back_to_an_earlier_signature_shows_who_is_missing(
    tmp_path: Path, versions: dict[str, bytes], authority: Authority
) -> None:
    report = verify_pdf(put(tmp_path, versions["verifier"]), authority.trust_roots)
    assert report.unsigned_fields == ("approver",)
    assert "not yet signed: approver" in report.text()


def test_a_file_saved_anew_is_found(tmp_path: Path, signed: bytes, authority: Authority) -> None:
    path = tmp_path / "saved.pdf"
    with pikepdf.open(io.BytesIO(signed)) as pdf:
        pdf.save(path)
    assert not verify_pdf(path, authority.trust_roots).valid


def test_a_stranger_who_signs_is_intact_and_not_trusted(
    tmp_path: Path, signed: bytes, tmp_path_factory: pytest.TempPathFactory
) -> None:
    other = Authority(tmp_path_factory.mktemp("other"))
    other.create()
    report = verify_pdf(put(tmp_path, signed), other.trust_roots)
    assert report.intact
    assert not report.trusted
    assert not report.valid
    assert "not every certificate leads to a trusted root" in report.text()


def test_without_roots_nothing_is_trusted(tmp_path: Path, signed: bytes) -> None:
    report = verify_pdf(put(tmp_path, signed))
    assert report.intact
    assert not report.valid


def test_an_unsigned_file_is_no_valid_certificate(
    tmp_path: Path, versions: dict[str, bytes], authority: Authority
) -> None:
    report = verify_pdf(put(tmp_path, versions["unsigned"]), authority.trust_roots)
    assert not report.valid
    assert not report.trusted
    assert report.signatures == ()
    assert report.text() == "The file is not signed"


def test_what_is_no_pdf_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not a PDF"):
        verify_pdf(put(tmp_path, b"PK\x03\x04 a zip"))
    with pytest.raises(InputError, match="is not a PDF"):
        verify_pdf(put(tmp_path, b""))
    with pytest.raises(InputError, match="cannot be read"):
        verify_pdf(tmp_path / "nowhere.pdf")
    with pytest.raises(InputError, match="cannot be read"):
        verify_pdf(tmp_path)


@pytest.mark.parametrize("share", [0.01, 0.3, 0.7, 0.9, 0.99, 0.9999])
def test_a_truncated_file_is_never_valid(
    tmp_path: Path, signed: bytes, authority: Authority, share: float
) -> None:
    path = put(tmp_path, signed[: int(share * len(signed))])
    try:
        report = verify_pdf(path, authority.trust_roots)
    except InputError:
        return  # a part that carries no signature any more is refused as damaged
    assert not report.valid


def test_an_encrypted_file_is_refused(tmp_path: Path, versions: dict[str, bytes]) -> None:
    path = tmp_path / "encrypted.pdf"
    with pikepdf.open(io.BytesIO(versions["unsigned"])) as pdf:
        pdf.save(path, encryption=pikepdf.Encryption(owner="owner", user="user"))
    with pytest.raises(InputError, match="encrypted"):
        verify_pdf(path)


def test_a_huge_file_is_refused(tmp_path: Path, signed: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verify, "_LARGEST_FILE", 1000)
    with pytest.raises(InputError, match="too large"):
        verify_pdf(put(tmp_path, signed))


def test_a_root_that_is_no_certificate_is_refused(tmp_path: Path, signed: bytes) -> None:
    root = tmp_path / "root.pem"
    root.write_text("nothing")
    with pytest.raises(InputError, match="not a certificate"):
        verify_pdf(put(tmp_path, signed), [root])


@settings(max_examples=60)
@given(st.binary(max_size=400))
def test_arbitrary_bytes_never_crash(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.mktemp("any") / "any.pdf"
    path.write_bytes(b"%PDF-1.7\n" + data + b"\n/ByteRange startxref\n0\n%%EOF")
    try:
        report = verify_pdf(path)
    except InputError:
        return
    assert not report.valid


def test_a_signers_name_writes_no_lines_of_the_report() -> None:
    from types import SimpleNamespace

    from ahrs_lab.certificates import verify

    name = {"common_name": "X\nIntact and unchanged\x1b[2J" + "y" * 500}
    shown = verify._signer_name(SimpleNamespace(subject=SimpleNamespace(native=name)))
    assert shown.startswith("X�Intact and unchanged�[2J")
    assert len(shown) == 100


def test_what_no_signature_protects_is_compared(tmp_path: Path, signed: bytes, authority: Authority) -> None:
    """The empty parameters of the digest's name mean nothing: a change there is found all the same."""
    first, second = (int(v) for v in re.findall(rb"/ByteRange \[0 (\d+) (\d+)", signed)[-1])
    sha256 = b"0609608648016503040201" + b"0500"
    hole = signed[first:second]
    places = [match.end() - 4 for match in re.finditer(sha256, hole)]
    assert len(places) >= 2
    for place in places:
        for instead in (b"08", b"75", b"45", b"25"):
            changed = signed[: first + place] + instead + signed[first + place + 2 :]
            report = verify_pdf(put(tmp_path, changed), authority.trust_roots)
            assert not report.valid, f"byte {place}: {instead!r}"


def with_container(signed: bytes, change: Callable[[bytes], bytes]) -> bytes:
    """The last signature's container changed, in the room that its hole leaves."""
    first, second = (int(v) for v in re.findall(rb"/ByteRange \[0 (\d+) (\d+)", signed)[-1])
    digits = signed[first + 1 : second - 1]
    container = bytes.fromhex(digits.decode("ascii"))
    other = change(container[: length_of(container)]).hex().encode("ascii")
    if digits == digits.upper():
        other = other.upper()
    assert len(other) <= len(digits)
    return signed[: first + 1] + other.ljust(len(digits), b"0") + signed[second - 1 :]


def parts_of(data: bytes) -> list[bytes]:
    """The values inside a value."""
    inside = data[2:] if data[1] < 0x80 else data[2 + (data[1] & 0x7F) :]
    found = []
    while inside:
        found.append(inside[: length_of(inside)])
        inside = inside[len(found[-1]) :]
    return found


def test_what_is_too_much_in_a_signatures_container_is_found(
    tmp_path: Path, signed: bytes, authority: Authority
) -> None:
    """Parsers pass over it; 480 bytes of anything could stand there."""
    hidden = value(0x04, b"hidden contents ")

    def at_the_end(container: bytes) -> bytes:
        return value(SEQUENCE, *parts_of(container), hidden)

    def in_the_signed_data(container: bytes) -> bytes:
        kind, content = parts_of(container)
        return value(SEQUENCE, kind, value(0xA0, value(SEQUENCE, *parts_of(parts_of(content)[0]), hidden)))

    def in_the_signer(container: bytes) -> bytes:
        kind, content = parts_of(container)
        *rest, signers = parts_of(parts_of(content)[0])
        (signer,) = parts_of(signers)
        more = value(SET, value(SEQUENCE, *parts_of(signer), hidden))
        return value(SEQUENCE, kind, value(0xA0, value(SEQUENCE, *rest, more)))

    def a_revocation_list(container: bytes) -> bytes:
        kind, content = parts_of(container)
        *rest, signers = parts_of(parts_of(content)[0])
        return value(SEQUENCE, kind, value(0xA0, value(SEQUENCE, *rest, value(0xA1, hidden), signers)))

    assert verify_pdf(put(tmp_path, with_container(signed, lambda c: c)), authority.trust_roots).valid
    for change in (at_the_end, in_the_signed_data, in_the_signer, a_revocation_list):
        report = verify_pdf(put(tmp_path, with_container(signed, change)), authority.trust_roots)
        assert not report.valid, change.__name__
