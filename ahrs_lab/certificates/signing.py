"""Three signatures, each an incremental update: the operator certifies, the verifier approves, the approver
locks.

A signature covers all bytes before it, so the file is never saved anew after the first one; each signature
only appends. Which person may sign which field is decided by the laboratory; here the order is kept, nobody
signs twice, and nobody signs what has been changed.
"""

from __future__ import annotations

import io
import tempfile
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ahrs_lab.certificates.authority import SigningIdentity
from ahrs_lab.certificates.job_sheet import Person
from ahrs_lab.certificates.layout import Role
from ahrs_lab.certificates.stamp import stamp_pdf
from ahrs_lab.certificates.verify import (
    ROLES,
    document_language,
    open_pdf,
    quiet_parsers,
    role_names,
    verify_pdf,
)
from ahrs_lab.errors import InputError, MachineError

if TYPE_CHECKING:
    from pyhanko.pdf_utils.reader import PdfFileReader

_REASONS = {
    "operator": "校准员 Operator: calibrated and certifies",
    "verifier": "核验员 Verifier: verified",
    "approver": "签发人 Approver: approved and issued",
}


def sign_certificate(
    path: Path,
    role: Role,
    signer: SigningIdentity,
    person: Person,
    *,
    target: Path | None = None,
) -> Path:
    """Sign the field of ``role`` and write to ``target`` (default: ``path`` itself, replaced at once).

    PAdES with the whole chain embedded, and the revocation list where the identity brings one.

    Raises:
        InputError: no such field, already signed, out of order, by somebody who signed before, or the file
        was
            changed after an earlier signature.
        MachineError: the file cannot be written.
    """
    reader = open_pdf(path)
    size = _checked_field(reader, path, role, signer)
    today = datetime.now().astimezone().date()
    stamp = stamp_pdf(person, today, size, document_language(reader))
    data = _signed(reader, role, signer, person, stamp)
    destination = target or path
    partial = destination.with_name(destination.name + ".part")
    try:
        partial.write_bytes(data)
        partial.replace(destination)
    except OSError as error:
        raise MachineError(
            "{path} cannot be written ({reason}): choose another folder or make room",
            path=destination,
            reason=error.strerror or error,
        ) from error
    return destination


def _checked_field(
    reader: PdfFileReader, path: Path, role: Role, identity: SigningIdentity
) -> tuple[float, float]:
    """Width and height of the empty field, points."""
    from pyhanko.sign.fields import enumerate_sig_fields

    names = role_names()
    fields = {name: (value, field) for name, value, field in enumerate_sig_fields(reader)}
    if role not in fields:
        raise InputError("{file} has no signature field for the {role}", file=path.name, role=names[role])
    if fields[role][0] is not None:
        raise InputError("{file} is already signed by the {role}", file=path.name, role=names[role])
    order = ROLES.index(role)
    for earlier in ROLES[:order]:
        if earlier in fields and fields[earlier][0] is None:
            raise InputError(
                "{file}: the {earlier} has to sign before the {role}",
                file=path.name,
                earlier=names[earlier],
                role=names[role],
            )
    for later in ROLES[order + 1 :]:
        if later in fields and fields[later][0] is not None:
            raise InputError(
                "{file}: the {later} has already signed, so the {role} cannot sign any more",
                file=path.name,
                later=names[later],
                role=names[role],
            )
    if order:
        _check_earlier(reader, path, identity)
    left, bottom, right, top = (float(value) for value in fields[role][1].get_object()["/Rect"])
    return right - left, top - bottom


def _check_earlier(reader: PdfFileReader, path: Path, identity: SigningIdentity) -> None:
    report = verify_pdf(path)
    if not report.intact:
        raise InputError(
            "{file} was changed after it was signed ({reason}): make the certificate again",
            file=path.name,
            reason=report.summary,
        )
    for embedded in reader.embedded_signatures:
        if embedded.signer_cert.dump() == identity.certificate_der:
            raise InputError(
                "{name} has already signed {file} as {role}: another person has to sign here",
                name=identity.name,
                file=path.name,
                role=role_names().get(embedded.field_name, embedded.field_name),
            )


def _signed(
    reader: PdfFileReader, role: Role, identity: SigningIdentity, person: Person, stamp: bytes
) -> bytes:
    from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
    from pyhanko.pdf_utils.layout import AxisAlignment as Align
    from pyhanko.pdf_utils.layout import Margins, SimpleBoxLayoutRule
    from pyhanko.sign import PdfSignatureMetadata, PdfSigner
    from pyhanko.sign.fields import MDPPerm, SigSeedSubFilter
    from pyhanko.stamp import StaticStampStyle

    context = _context(identity)
    metadata = PdfSignatureMetadata(
        field_name=role,
        md_algorithm="sha256",
        name=person.name,
        reason=_REASONS[role],
        subfilter=SigSeedSubFilter.PADES,
        certify=role == "operator",
        docmdp_permissions=MDPPerm.FILL_FORMS,
        validation_context=context,
        embed_validation_info=context is not None,
        dss_settings=_dss_settings(),
    )
    with tempfile.TemporaryDirectory() as folder:
        stamp_file = Path(folder) / "stamp.pdf"
        stamp_file.write_bytes(stamp)
        style = StaticStampStyle.from_pdf_file(
            str(stamp_file),
            border_width=0,
            background_opacity=1.0,
            background_layout=SimpleBoxLayoutRule(Align.ALIGN_MID, Align.ALIGN_MID, Margins()),
        )
        pdf_signer = PdfSigner(metadata, _signer(identity), stamp_style=style)
        reader.stream.seek(0)
        writer = IncrementalPdfFileWriter(io.BytesIO(reader.stream.read()))
        with quiet_parsers():
            output: io.BytesIO = pdf_signer.sign_pdf(writer, existing_fields_only=True, in_place=False)
    return output.getvalue()


def _dss_settings() -> Any:
    from pyhanko.sign.signers.pdf_signer import DSSContentSettings, SigDSSPlacementPreference

    return DSSContentSettings(include_vri=False, placement=SigDSSPlacementPreference.TOGETHER_WITH_SIGNATURE)


def _signer(identity: SigningIdentity) -> Any:
    from asn1crypto import keys, x509
    from pyhanko.sign import SimpleSigner
    from pyhanko_certvalidator.registry import SimpleCertificateStore

    store = SimpleCertificateStore()  # type: ignore[no-untyped-call]
    # A root is known to who trusts it; inside the signature nothing would protect it. It is in the DSS.
    chain = [x509.Certificate.load(one) for one in identity.chain_der]
    store.register_multiple([one for one in chain if one.self_signed == "no"])
    return SimpleSigner(
        signing_cert=x509.Certificate.load(identity.certificate_der),
        signing_key=keys.PrivateKeyInfo.load(identity.key_der),
        cert_registry=store,
    )


def _context(identity: SigningIdentity) -> Any:
    """What proves the signer's certificate, to be embedded; None where there is no revocation list."""
    from asn1crypto import crl, x509
    from pyhanko_certvalidator import ValidationContext

    if not identity.crls_der:
        return None
    chain = [x509.Certificate.load(one) for one in identity.chain_der]
    return ValidationContext(
        trust_roots=[one for one in chain if one.self_signed in ("yes", "maybe")],
        other_certs=chain,
        crls=[crl.CertificateList.load(one) for one in identity.crls_der],
        allow_fetching=False,
        revocation_mode="hard-fail",
    )
