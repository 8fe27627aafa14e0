"""Who signed a PDF, when, and whether anything changed since: by difference analysis of the incremental
updates.

A signature only proves the bytes it covers. What was appended later is compared object by object with what
was signed, and judged by what the certifying signature permits. The file may come from anybody.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ahrs_lab.certificates.der import SEQUENCE, SET, is_distinguished, length_of, value
from ahrs_lab.certificates.job_sheet import CertificateLanguage
from ahrs_lab.errors import InputError
from ahrs_lab.messages import Message

if TYPE_CHECKING:
    from pyhanko.pdf_utils.reader import PdfFileReader

ROLES = ("operator", "verifier", "approver")
Modification = Literal["none", "allowed", "forbidden"]

_LARGEST_FILE = 100_000_000
_MOST_SIGNATURES = 50
_EXPLICIT = 0xA0
_LONGEST_NAME = 100


@dataclass(frozen=True)
class SignatureReport:
    """One signature. ``intact``: the bytes it covers are as signed and the signature is the signer's.

    ``covers_whole``: nothing was appended after it. ``modification`` judges what was.
    """

    field: str
    role: str
    signer: str
    signed_at: datetime | None
    trusted: bool
    intact: bool
    covers_whole: bool
    modification: Modification
    problems: tuple[Message, ...] = ()


@dataclass(frozen=True)
class VerificationReport:
    """``intact``: at least one signature, each intact, and nothing changed since that was not permitted.

    ``changed_since`` says what was changed after a signature; ``unsigned_fields`` are still empty.
    """

    intact: bool
    signatures: tuple[SignatureReport, ...]
    changed_since: Message | None
    summary: Message
    unsigned_fields: tuple[str, ...] = ()

    @property
    def valid(self) -> bool:
        """Intact, unchanged, and by signers who lead to a trusted root: what ``ahrs-lab verify`` answers."""
        return self.intact and self.trusted

    def text(self, language: str = "en") -> str:
        """Verdict and signatures, a line each."""
        lines = [self.summary.text(language)]
        for one in self.signatures:
            when = one.signed_at.isoformat(sep=" ", timespec="seconds") if one.signed_at else "–"
            role = role_names().get(one.role)
            lines.append(f"  {role.text(language) if role else one.field}: {one.signer}, {when}")
            lines += [f"    {problem.text(language)}" for problem in one.problems]
        return "\n".join(lines)

    def to_json(self) -> dict[str, Any]:
        """All of it, messages in English."""
        return {
            "valid": self.valid,
            "intact": self.intact,
            "trusted": self.trusted,
            "summary": self.summary.text(),
            "changed_since": self.changed_since.text() if self.changed_since else None,
            "unsigned_fields": list(self.unsigned_fields),
            "signatures": [
                {
                    "field": one.field,
                    "role": one.role,
                    "signer": one.signer,
                    "signed_at": one.signed_at.isoformat() if one.signed_at else None,
                    "trusted": one.trusted,
                    "intact": one.intact,
                    "covers_whole": one.covers_whole,
                    "modification": one.modification,
                    "problems": [problem.text() for problem in one.problems],
                }
                for one in self.signatures
            ],
        }

    @property
    def trusted(self) -> bool:
        """Intact, and every signer's certificate leads to a trusted root."""
        return self.intact and all(signature.trusted for signature in self.signatures)


def open_pdf(path: Path) -> PdfFileReader:
    """A reader of the whole file in memory.

    Raises:
        InputError: cannot be read, not a PDF, too large, or encrypted.
    """
    with quiet_parsers():
        reader = _parsed(_read(path), path)
    _refuse_encrypted(reader, path)
    return reader


def document_language(reader: PdfFileReader) -> CertificateLanguage:
    """The languages the certificate was laid out in."""
    try:
        found = str(reader.trailer["/Info"]["/CertificateLanguage"])
    except (KeyError, TypeError):
        return "bilingual"
    return "en" if found == "en" else "zh" if found == "zh" else "bilingual"


def verify_pdf(path: Path, trust_roots: Sequence[Path] = ()) -> VerificationReport:
    """Check every signature of a PDF against the certificates in ``trust_roots`` (PEM or DER).

    A damaged file that carries signatures is a report with ``intact=False``, not an error.

    Raises:
        InputError: cannot be read, not a PDF, too large, or encrypted; a root that is no certificate.
    """
    roots = _certificates(trust_roots)
    data = _read(path)
    with quiet_parsers():
        return _verified(data, path, roots)


def _verified(data: bytes, path: Path, roots: list[Any]) -> VerificationReport:
    try:
        reader = _parsed(data, path)
    except InputError as error:
        if b"/ByteRange" in data:
            return _damaged(error.message)
        raise
    _refuse_encrypted(reader, path)
    try:
        embedded = list(reader.embedded_signatures)
        empty = _empty_fields(reader)
    except Exception as error:
        # The parser meets bytes of anybody; whatever it stumbles over, the file is not what was signed.
        return _damaged(Message("its signature fields cannot be read ({reason})", reason=_brief(error)))
    if len(embedded) > _MOST_SIGNATURES:
        raise InputError(
            "{file} carries more than {limit} signatures", file=path.name, limit=_MOST_SIGNATURES
        )
    reports = tuple(_signature(one, roots, last=one is embedded[-1]) for one in embedded)
    return _concluded(reports, empty)


def role_names() -> dict[str, Message]:
    """The roles as they stand in a sentence."""
    return {"operator": Message("operator"), "verifier": Message("verifier"), "approver": Message("approver")}


@contextmanager
def quiet_parsers() -> Iterator[None]:
    """Without pyHanko's log lines: what they say is in the report, or is an error with a message of its
    own."""
    loggers = [logging.getLogger(name) for name in ("pyhanko", "pyhanko_certvalidator")]
    before = [logger.level for logger in loggers]
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL + 1)
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)


# ── reading ──────────────────────────────────────────────────────────────────────────────────────────────


def _read(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST_FILE + 1)
    except OSError as error:
        raise InputError(
            "{path} cannot be read ({reason})", path=path, reason=error.strerror or error
        ) from error
    if len(data) > _LARGEST_FILE:
        raise InputError("{file} is too large (more than {limit} bytes)", file=path.name, limit=_LARGEST_FILE)
    if b"%PDF-" not in data[:1024]:
        raise InputError("{file} is not a PDF", file=path.name)
    return data


def _parsed(data: bytes, path: Path) -> PdfFileReader:
    from pyhanko.pdf_utils.reader import PdfFileReader

    try:
        reader = PdfFileReader(io.BytesIO(data))
        if not reader.encrypted:
            _ = reader.root["/Pages"]
    except Exception as error:
        # See _verified: a parser on bytes of anybody.
        raise InputError(
            "{file} is damaged or incomplete and cannot be read as a PDF ({reason})",
            file=path.name,
            reason=_brief(error),
        ) from error
    return reader


def _refuse_encrypted(reader: PdfFileReader, path: Path) -> None:
    if reader.encrypted:
        raise InputError(
            "{file} is encrypted: certificates are not; ask for the original file", file=path.name
        )


def _brief(error: Exception) -> str:
    return (str(error).splitlines() or [""])[0][:200] or type(error).__name__


def _certificates(paths: Sequence[Path]) -> list[Any]:
    from asn1crypto import x509
    from cryptography.hazmat.primitives.serialization import Encoding
    from cryptography.x509 import load_der_x509_certificate, load_pem_x509_certificate

    found = []
    for path in paths:
        try:
            data = path.read_bytes()
            loaded = (
                load_pem_x509_certificate(data) if b"-----BEGIN" in data else load_der_x509_certificate(data)
            )
        except (OSError, ValueError) as error:
            raise InputError("{path} is not a certificate that can be trusted", path=path) from error
        found.append(x509.Certificate.load(loaded.public_bytes(Encoding.DER)))
    return found


def _empty_fields(reader: PdfFileReader) -> tuple[str, ...]:
    from pyhanko.sign.fields import enumerate_sig_fields

    return tuple(str(name) for name, value, _ in enumerate_sig_fields(reader) if value is None)


# ── one signature ────────────────────────────────────────────────────────────────────────────────────────


def _signature(embedded: Any, roots: list[Any], *, last: bool) -> SignatureReport:
    from pyhanko.sign.validation import validate_pdf_signature
    from pyhanko_certvalidator import ValidationContext

    field = str(embedded.field_name)
    try:
        context = ValidationContext(trust_roots=roots, allow_fetching=False, revocation_mode="soft-fail")
        status = validate_pdf_signature(embedded, context)
        signer = _signer_name(embedded.signer_cert)
        return _judged(embedded, status, signer, field, last=last)
    except Exception as error:
        # See _verified: a parser on bytes of anybody. The failure is the finding.
        problem = Message(
            "The signature of {field} cannot be checked ({reason})", field=field, reason=_brief(error)
        )
        return SignatureReport(
            field=field,
            role=field if field in ROLES else "",
            signer="",
            signed_at=None,
            trusted=False,
            intact=False,
            covers_whole=False,
            modification="forbidden",
            problems=(problem,),
        )


def _signer_name(certificate: Any) -> str:
    """One short line, whatever the certificate says: a name must not write lines of the report itself."""
    native = certificate.subject.native
    name = str(native.get("common_name") or certificate.subject.human_friendly)
    return "".join(c if c.isprintable() else "�" for c in name[:_LONGEST_NAME])


def _judged(embedded: Any, status: Any, signer: str, field: str, *, last: bool) -> SignatureReport:
    from pyhanko.sign.validation import SignatureCoverageLevel

    whole = status.coverage == SignatureCoverageLevel.ENTIRE_FILE
    modification = _modification(status, whole=whole, last=last)
    if modification == "allowed" and last and not _says_the_same(embedded):
        modification = "forbidden"
    intact = bool(status.intact and status.valid and (not last or _is_canonical(embedded)))
    problems: list[Message] = []
    if not status.intact:
        problems.append(Message("The bytes signed by {signer} were changed", signer=signer))
    elif not intact:
        problems.append(
            Message("The signature does not belong to the certificate of {signer}", signer=signer)
        )
    if modification == "forbidden":
        problems.append(Message("The file was changed after {signer} signed it", signer=signer))
    if getattr(status, "revoked", False):
        problems.append(Message("The certificate of {signer} was revoked", signer=signer))
    return SignatureReport(
        field=field,
        role=field if field in ROLES else "",
        signer=signer,
        signed_at=embedded.self_reported_timestamp,
        trusted=bool(status.trusted),
        intact=intact,
        covers_whole=whole,
        modification=modification,
        problems=tuple(problems),
    )


def _is_canonical(embedded: Any) -> bool:
    """Whether the hole that holds the signature holds nothing else: hexadecimal of one case, zeros behind it.

    The hole of the last signature is covered by none, so a change there is only found by looking at them.
    What the signature's own container repeats without protecting it is compared with what is protected.
    """
    _, first, second, _ = (int(value) for value in embedded.byte_range)
    stream = embedded.reader.stream
    stream.seek(first)
    hole: bytes = stream.read(second - first)
    digits = hole[1:-1]
    if hole[:1] != b"<" or hole[-1:] != b">" or digits not in (digits.upper(), digits.lower()):
        return False
    container = bytes.fromhex(digits.decode("ascii"))
    size = length_of(container)
    info, certificate, whole = embedded.signer_info, embedded.signer_cert, embedded.signed_data
    exact = _container(container, whole, info)
    if container[:size] != exact or not is_distinguished(exact) or any(container[size:]):
        return False
    # Behind its implicit tag this is a set, in order therefore.
    certificates = [one.dump() for one in whole["certificates"]]
    plain = all(one.name == "certificate" for one in whole["certificates"])
    if certificates != sorted(set(certificates)) or not plain:
        return False
    # What no signature protects is written anew: so also its values are the only ones it can mean.
    bare = [whole["version"], whole["digest_algorithms"], whole["encap_content_info"]]
    bare += [info[name] for name in ("version", "sid", "digest_algorithm", "signature_algorithm")]
    if any(part.dump() != part.copy().dump(force=True) for part in bare):
        return False
    algorithms = [one["algorithm"].native for one in embedded.signed_data["digest_algorithms"]]
    beside = {str(one["type"].native) for one in info["unsigned_attrs"]}
    version, outer = str(info["version"].native), str(embedded.signed_data["version"].native)
    return (
        outer in (version, "v4", "v5")
        and algorithms == [info["digest_algorithm"]["algorithm"].native]
        # A time stamp proves itself, anything else beside the signature is unprotected.
        and beside <= {"signature_time_stamp_token"}
        and _names_signer(info["sid"], certificate, version)
    )


def _container(container: bytes, whole: Any, info: Any) -> bytes:
    """The signature's container of the parts that are looked at and nothing beside them: parsers pass over
    what is too much."""
    from asn1crypto.cms import ContentInfo

    of_signer = ("version", "sid", "digest_algorithm", "signed_attrs", "signature_algorithm", "signature")
    signer = [info[name].dump() for name in of_signer]
    if len(info["unsigned_attrs"]):
        signer.append(info["unsigned_attrs"].dump())
    of_signed = ("version", "digest_algorithms", "encap_content_info", "certificates")
    signed = [*(whole[name].dump() for name in of_signed), value(SET, value(SEQUENCE, *signer))]
    kind = ContentInfo.load(container)["content_type"].dump()
    return value(SEQUENCE, kind, value(_EXPLICIT, value(SEQUENCE, *signed)))


def _names_signer(identifier: Any, certificate: Any, version: str) -> bool:
    """RFC 5652, 5.3: which version goes with which way of naming the signer."""
    named = identifier.chosen
    if identifier.name == "issuer_and_serial_number":
        return bool(
            version == "v1"
            and named["issuer"].dump() == certificate.issuer.dump()
            and named["serial_number"].native == certificate.serial_number
        )
    return bool(version == "v3" and named.native == certificate.key_identifier)


def _modification(status: Any, *, whole: bool, last: bool) -> Modification:
    """What was appended after the signature, by the rules of the certifying signature and the locks.

    After the last signature of our files nothing is to come but validation data of the signatures themselves.
    """
    from pyhanko.sign.diff_analysis import ModificationLevel
    from pyhanko.sign.validation import SignatureCoverageLevel

    if whole:
        return "none"
    if status.coverage != SignatureCoverageLevel.ENTIRE_REVISION:
        return "forbidden"
    level = status.modification_level
    permitted = status.docmdp_ok is not False and level in (
        ModificationLevel.NONE,
        ModificationLevel.LTA_UPDATES,
        ModificationLevel.FORM_FILLING,
    )
    if not permitted or (last and level != ModificationLevel.LTA_UPDATES):
        return "forbidden"
    return "allowed"


def _says_the_same(embedded: Any) -> bool:
    """Title, author and the like are as when they were signed: the rules let them be written anew, because
    who adds validation data writes date and producer."""
    reader = embedded.reader
    signed = reader.get_historical_resolver(embedded.signed_revision)
    return described(signed) == described(reader)


def described(revision: Any) -> tuple[dict[str, str], list[tuple[str, ...]]]:
    """What a document says of itself in one revision, in its information dictionary and its metadata, but for
    when and with what it was written."""

    def part(of: Any, key: str) -> Any:
        # not by of[key], which would take a later revision's
        value = of.raw_get(key) if key in of else None
        reference = getattr(value, "reference", None)
        return value if reference is None else revision.get_object(reference)

    info = part(revision.trailer_view, "/Info") or {}
    entries = {key: str(part(info, key)) for key in info if key not in ("/ModDate", "/Producer")}
    metadata = part(part(revision.trailer_view, "/Root"), "/Metadata")
    return entries, [] if metadata is None else statements(metadata.data)


def statements(metadata: bytes) -> list[tuple[str, ...]]:
    """The elements of XMP metadata in their order: name, attributes, text."""
    from lxml import etree

    parser = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True)
    found = []
    for element in etree.fromstring(metadata, parser).iter(etree.Element):
        if element.tag not in _OF_THE_WRITING:
            attributes = sorted(entry for entry in element.items() if entry[0] not in _OF_THE_WRITING)
            texts = (element.text or "").strip(), (element.tail or "").strip()
            found.append((str(element.tag), *(str(part) for entry in attributes for part in entry), *texts))
    return found


_OF_THE_WRITING = frozenset(
    [f"{{http://ns.adobe.com/xap/1.0/}}{name}" for name in ("ModifyDate", "MetadataDate")]
    + ["{http://ns.adobe.com/pdf/1.3/}Producer", "{adobe:ns:meta/}xmptk"]
)


# ── the whole file ───────────────────────────────────────────────────────────────────────────────────────


def _damaged(reason: Message) -> VerificationReport:
    summary = Message("The file carries signatures, but it is damaged: {reason}", reason=reason)
    return VerificationReport(intact=False, signatures=(), changed_since=summary, summary=summary)


def _concluded(reports: tuple[SignatureReport, ...], empty: tuple[str, ...]) -> VerificationReport:
    if not reports:
        return VerificationReport(False, (), None, Message("The file is not signed"), empty)
    intact = all(one.intact and one.modification != "forbidden" for one in reports)
    changed = next(
        (one.problems[0] for one in reports if not one.intact or one.modification == "forbidden"), None
    )
    who = ", ".join(one.signer for one in reports)
    if not intact:
        summary = Message("NOT intact: {reason}", reason=changed or Message("a signature is not valid"))
    elif empty:
        summary = Message(
            "Intact, signed by {who}; not yet signed: {missing}", who=who, missing=", ".join(empty)
        )
    elif all(one.trusted for one in reports):
        summary = Message("Intact and unchanged since it was signed by {who}", who=who)
    else:
        summary = Message(
            "Intact and unchanged since it was signed by {who}; not every certificate leads to a "
            "trusted root",
            who=who,
        )
    return VerificationReport(intact, reports, changed, summary, empty)
