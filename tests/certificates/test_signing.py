"""Three signatures in their order, by three people, and keys that nobody reads from the disk."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import pikepdf
import pytest
from cryptography.hazmat.primitives.serialization import load_pem_private_key, pkcs12
from cryptography.x509 import load_pem_x509_certificate

from ahrs_lab.certificates.authority import Authority, SigningIdentity, load_identity
from ahrs_lab.certificates.certificate import certificate_pdf
from ahrs_lab.certificates.job_sheet import JobSheet, Person
from ahrs_lab.certificates.layout import Role
from ahrs_lab.certificates.plots import plots_pdf
from ahrs_lab.certificates.signing import sign_certificate
from ahrs_lab.certificates.stamp import stamp_pdf
from ahrs_lab.certificates.verify import verify_pdf
from ahrs_lab.errors import InputError, PermissionDeniedError
from ahrs_lab.metrology.result import CalibrationResult
from tests.certificates.pdf_text import spans

ROLES: tuple[Role, ...] = ("operator", "verifier", "approver")


@dataclass(frozen=True)
class Desk:
    """An unsigned certificate and the people who will sign it."""

    path: Path
    job: JobSheet
    authority: Authority

    def identity(self, role: Role) -> SigningIdentity:
        return self.authority.unlock(role, f"password of {role}")

    def sign(self, role: Role, signer: Role | None = None) -> Path:
        return sign_certificate(self.path, role, self.identity(signer or role), getattr(self.job, role))


@pytest.fixture(scope="module")
def authority(tmp_path_factory: pytest.TempPathFactory) -> Authority:
    made = Authority(tmp_path_factory.mktemp("authority"))
    for role in ROLES:
        made.issue(role, f"Demo {role}", f"password of {role}")
    return made


@pytest.fixture
def desk(tmp_path: Path, result: CalibrationResult, job: JobSheet, authority: Authority) -> Desk:
    return Desk(certificate_pdf(result, job, tmp_path / "certificate.pdf"), job, authority)


def test_three_people_sign_one_after_the_other(desk: Desk) -> None:
    before = desk.path.read_bytes()
    for count, role in enumerate(ROLES, 1):
        desk.sign(role)
        after = desk.path.read_bytes()
        assert after.startswith(before), "a signature only appends"
        before = after
        report = verify_pdf(desk.path, desk.authority.trust_roots)
        assert report.valid
        assert [one.role for one in report.signatures] == list(ROLES[:count])
        assert report.unsigned_fields == ROLES[count:]
    assert [one.signer for one in report.signatures] == [f"Demo {role} (Demonstration)" for role in ROLES]
    assert [one.covers_whole for one in report.signatures] == [False, False, True]
    assert [one.modification for one in report.signatures] == ["allowed", "allowed", "none"]
    assert all(one.signed_at is not None and one.problems == () for one in report.signatures)
    assert report.changed_since is None


@pytest.mark.skipif(shutil.which("pdfsig") is None, reason="pdfsig (poppler-utils) is not installed")
def test_pdfsig_agrees_on_three_valid_signatures(desk: Desk) -> None:
    for role in ROLES:
        desk.sign(role)
    said = subprocess.run(["pdfsig", "-nocert", str(desk.path)], capture_output=True, text=True, check=False)
    assert said.stdout.count("Signature Validation: Signature is Valid.") == 3
    assert said.stdout.count("Total document signed") == 1
    assert said.stdout.count("ETSI.CAdES.detached") == 3


def test_the_operator_certifies_and_the_approver_locks(desk: Desk) -> None:
    for role in ROLES:
        desk.sign(role)
    with pikepdf.open(desk.path) as pdf:
        values = {str(field.T): field.V for field in pdf.Root.AcroForm.Fields}
        assert pdf.Root.Perms.DocMDP.objgen == values["operator"].objgen
        assert "/Reference" not in values["verifier"]
        locks = [reference.TransformMethod for reference in values["approver"].Reference]
        assert "/FieldMDP" in [str(lock) for lock in locks]
        assert all(str(value.SubFilter) == "/ETSI.CAdES.detached" for value in values.values())
        assert "/DSS" in pdf.Root
        assert len(pdf.Root.DSS.CRLs) >= 1


def test_the_stamp_shows_name_position_and_date(desk: Desk) -> None:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext (poppler-utils) is not installed")
    desk.sign("operator")
    text = subprocess.run(
        ["pdftotext", str(desk.path), "-"], capture_output=True, text=True, check=True
    ).stdout
    for words in ("演示校准员", "Demonstration Operator", "校准工程师", "Digitally signed"):
        assert words in text
    assert text.count("to be signed digitally") == 2, "what the other two fields still show"


def test_embedded_fonts_stay_embedded_after_signing(desk: Desk) -> None:
    for role in ROLES:
        desk.sign(role)
    with pikepdf.open(desk.path) as pdf:
        fonts = [o for o in pdf.objects if isinstance(o, pikepdf.Dictionary) and o.get("/Type") == "/Font"]
        assert all("/FontFile2" in font.FontDescriptor for font in fonts)


@pytest.mark.parametrize(
    ("signed", "role", "says"),
    [
        ([], "verifier", "the operator has to sign before the verifier"),
        ([], "approver", "the operator has to sign before the approver"),
        (["operator"], "approver", "the verifier has to sign before the approver"),
        (["operator"], "operator", "already signed by the operator"),
        (["operator", "verifier"], "verifier", "already signed by the verifier"),
    ],
)
def test_order_is_kept_and_nobody_signs_twice(desk: Desk, signed: list[Role], role: Role, says: str) -> None:
    for earlier in signed:
        desk.sign(earlier)
    before = desk.path.read_bytes()
    with pytest.raises(InputError, match=says):
        desk.sign(role)
    assert desk.path.read_bytes() == before


def test_one_person_cannot_sign_two_fields(desk: Desk) -> None:
    desk.sign("operator")
    with pytest.raises(InputError, match=r"has already signed .* as operator: another person"):
        desk.sign("verifier", signer="operator")


def test_nobody_signs_what_was_changed(desk: Desk) -> None:
    desk.sign("operator")
    data = desk.path.read_bytes()
    desk.path.write_bytes(data.replace(b"/MediaBox", b"/mediaBox", 1))
    with pytest.raises(InputError, match="was changed after it was signed"):
        desk.sign("verifier")


def test_a_file_without_fields_is_refused(tmp_path: Path, result: CalibrationResult, desk: Desk) -> None:
    plots = plots_pdf(result, tmp_path / "plots.pdf")
    with pytest.raises(InputError, match="no signature field for the operator"):
        sign_certificate(plots, "operator", desk.identity("operator"), desk.job.operator)


def test_a_long_name_fits_its_stamp(tmp_path: Path, desk: Desk) -> None:
    person = Person("欧阳" * 20, "授权签字人" * 20, "Maximiliana " * 12, "Head of the laboratory " * 9)
    stamp = tmp_path / "stamp.pdf"
    stamp.write_bytes(stamp_pdf(person, date(2026, 11, 23), (140.0, 58.0)))
    assert all(s.x >= 0 and s.x + s.width <= 140 and 0 <= s.y <= 58 for s in spans(stamp))


# ── keys ─────────────────────────────────────────────────────────────────────────────────────────────────


def test_keys_are_encrypted_on_disk(authority: Authority) -> None:
    key = (authority.folder / "root-key.pem").read_bytes()
    assert b"BEGIN ENCRYPTED PRIVATE KEY" in key
    with pytest.raises(TypeError, match="encrypted"):
        load_pem_private_key(key, None)
    for role in ROLES:
        data = (authority.folder / "people" / f"{role}.p12").read_bytes()
        with pytest.raises(ValueError, match="password"):
            pkcs12.load_key_and_certificates(data, b"")


def test_private_files_are_their_owners(authority: Authority) -> None:
    if os.name != "posix":
        pytest.skip("modes are POSIX")
    for name in ("root-key.pem", "root-key.passphrase", "people/operator.p12"):
        assert (authority.folder / name).stat().st_mode & 0o077 == 0


def test_a_wrong_password_opens_nothing(authority: Authority) -> None:
    with pytest.raises(PermissionDeniedError, match="password is wrong"):
        authority.unlock("operator", "guess")
    with pytest.raises(InputError, match="no signing certificate yet"):
        authority.unlock("nobody", "guess")


def test_every_name_says_demonstration(authority: Authority) -> None:
    root = load_pem_x509_certificate((authority.folder / "root.pem").read_bytes())
    assert "Demonstration" in root.subject.rfc4514_string()
    assert authority.unlock("operator", "password of operator").name.endswith("(Demonstration)")


def test_creating_again_changes_nothing(authority: Authority) -> None:
    before = (authority.folder / "root.pem").read_bytes()
    authority.create()
    assert (authority.folder / "root.pem").read_bytes() == before


@pytest.mark.parametrize("name", ["../operator", "a/b", "", "..", "x" * 65])
def test_a_key_name_never_leaves_the_folder(authority: Authority, name: str) -> None:
    with pytest.raises(InputError, match="cannot be used"):
        authority.issue(name, "Somebody", "password")


def test_an_empty_password_or_a_wrong_passphrase_is_refused(tmp_path: Path) -> None:
    own = Authority(tmp_path / "own", "correct horse")
    with pytest.raises(InputError, match="not empty"):
        own.issue("operator", "Somebody", "")
    own.issue("operator", "Somebody", "secret")
    with pytest.raises(InputError, match="wrong passphrase"):
        Authority(tmp_path / "own", "wrong").issue("verifier", "Somebody else", "secret")


def test_a_persons_own_pkcs12_signs(desk: Desk, authority: Authority) -> None:
    own = load_identity(authority.folder / "people" / "operator.p12", "password of operator")
    sign_certificate(desk.path, "operator", own, desk.job.operator)
    report = verify_pdf(desk.path, authority.trust_roots)
    assert report.valid


def test_what_is_no_pkcs12_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.p12"
    path.write_bytes(b"nothing of the kind")
    with pytest.raises(InputError, match="not a PKCS#12 file"):
        load_identity(path, "password")


def test_an_identity_does_not_show_its_key(authority: Authority) -> None:
    assert "key" not in repr(authority.unlock("operator", "password of operator"))
