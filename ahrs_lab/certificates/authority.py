"""The demonstration certificate authority, and the identities people sign with.

At first start a demonstration laboratory has nobody to issue signing certificates, so it makes its own
authority. Every name in it says that it is a demonstration. A real laboratory loads its people's own
PKCS#12 files instead.
"""

from __future__ import annotations

import os
import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from ahrs_lab.errors import InputError, MachineError, PermissionDeniedError

if TYPE_CHECKING:
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePrivateKey
    from cryptography.hazmat.primitives.serialization import KeySerializationEncryption

ORGANISATION = "Demonstration - not a legal signature"
ROOT_NAME = "ahrs_lab Demonstration Root CA"
_ROOT_FILE, _ROOT_KEY_FILE, _CRL_FILE, _PEOPLE = "root.pem", "root-key.pem", "root.crl", "people"
_PASSPHRASE_FILE = "root-key.passphrase"
_ROOT_YEARS, _PERSON_YEARS = 20, 5
_KDF_ROUNDS = 100_000
_LARGEST_IDENTITY = 1_000_000
_PERSON_ID = re.compile(r"[A-Za-z0-9_.-]{1,64}")


@dataclass(frozen=True)
class SigningIdentity:
    """A person's key and certificate, open for use. ``crls`` are DER; kept in memory only."""

    name: str
    key_der: bytes
    certificate_der: bytes
    chain_der: tuple[bytes, ...] = ()
    crls_der: tuple[bytes, ...] = ()

    def __repr__(self) -> str:
        return f"SigningIdentity({self.name!r})"


def load_identity(path: Path, password: str, crls: tuple[Path, ...] = ()) -> SigningIdentity:
    """Open a PKCS#12 file (``.p12``, ``.pfx``) with the person's own password.

    Raises:
        PermissionDeniedError: wrong password, or not such a file.
        InputError: cannot be read, or no key and certificate in it.
    """
    from cryptography import x509
    from cryptography.hazmat.primitives.serialization import (
        Encoding,
        NoEncryption,
        PrivateFormat,
        pkcs12,
    )

    data = _read(path)
    try:
        key, certificate, chain = pkcs12.load_key_and_certificates(data, password.encode())
        revoked = tuple(x509.load_der_x509_crl(_read(crl)).public_bytes(Encoding.DER) for crl in crls)
    except ValueError as error:
        raise PermissionDeniedError(
            "{path} cannot be opened: the password is wrong, or it is not a PKCS#12 file", path=path
        ) from error
    if key is None or certificate is None:
        raise InputError("{path} does not hold both a private key and its certificate", path=path)
    return SigningIdentity(
        name=common_name(certificate),
        key_der=key.private_bytes(Encoding.DER, PrivateFormat.PKCS8, NoEncryption()),
        certificate_der=certificate.public_bytes(Encoding.DER),
        chain_der=tuple(one.public_bytes(Encoding.DER) for one in chain),
        crls_der=revoked,
    )


def common_name(certificate: x509.Certificate) -> str:
    """The subject's name as people read it."""
    from cryptography.x509.oid import NameOID

    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    return str(names[0].value) if names else certificate.subject.rfc4514_string()


class Authority:
    """A root and one certificate a person, in a folder of its own.

    The root's key is kept as PKCS#8 under a passphrase, each person's as PKCS#12 under the person's password.
    """

    def __init__(self, folder: Path, passphrase: str | None = None) -> None:
        self.folder = folder
        self._given = passphrase

    @property
    def exists(self) -> bool:
        """Whether the authority has been created."""
        return all((self.folder / name).is_file() for name in (_ROOT_FILE, _ROOT_KEY_FILE, _CRL_FILE))

    @property
    def trust_roots(self) -> tuple[Path, ...]:
        """What ``verify`` has to trust."""
        return (self.folder / _ROOT_FILE,)

    def create(self, *, now: datetime | None = None) -> None:
        """Make root, its encrypted key and an empty revocation list; leaves an existing authority as it is.

        Raises:
            MachineError: the folder cannot be written.
        """
        from cryptography.hazmat.primitives.asymmetric import ec
        from cryptography.hazmat.primitives.serialization import (
            BestAvailableEncryption,
            Encoding,
            PrivateFormat,
        )

        if self.exists:
            return
        moment = now or datetime.now(UTC)
        key = ec.generate_private_key(ec.SECP256R1())
        root = _root_certificate(key, moment)
        with _writing(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            (self.folder / _PEOPLE).mkdir(exist_ok=True, mode=0o700)
            encryption = BestAvailableEncryption(self._passphrase().encode())
            _write_private(
                self.folder / _ROOT_KEY_FILE, key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, encryption)
            )
            (self.folder / _CRL_FILE).write_bytes(_revocation_list(key, root, moment))
            (self.folder / _ROOT_FILE).write_bytes(root.public_bytes(Encoding.PEM))

    def issue(self, key_name: str, common_name: str, password: str, *, now: datetime | None = None) -> Path:
        """A certificate for a person (``common_name`` as it is to be read), kept under the person's
        ``password``.

        Makes the authority at first use; replaces an earlier certificate of the same ``key_name``.

        Raises:
            InputError: an empty password, a key name that is no plain file name, a wrong passphrase.
            MachineError: the folder cannot be written.
        """
        from cryptography.hazmat.primitives.asymmetric import ec
        from cryptography.hazmat.primitives.serialization import pkcs12

        path = self._person_file(key_name)
        encryption = _pkcs12_encryption(password)
        self.create(now=now)
        root_key, root = self._open()
        key = ec.generate_private_key(ec.SECP256R1())
        certificate = _person_certificate(key, common_name, root_key, root, now or datetime.now(UTC))
        data = pkcs12.serialize_key_and_certificates(key_name.encode(), key, certificate, [root], encryption)
        with _writing(path.parent):
            path.parent.mkdir(parents=True, exist_ok=True)
            _write_private(path, data)
        return path

    def unlock(self, key_name: str, password: str) -> SigningIdentity:
        """Open a person's key.

        Raises:
            PermissionDeniedError: wrong password.
            InputError: the person has no certificate.
        """
        path = self._person_file(key_name)
        if not path.is_file():
            raise InputError("{person} has no signing certificate yet: issue one first", person=key_name)
        return load_identity(path, password, (self.folder / _CRL_FILE,))

    def has(self, key_name: str) -> bool:
        """Whether the person has a certificate."""
        return self._person_file(key_name).is_file()

    def _passphrase(self) -> str:
        """The one given, or one made at first start and kept beside the key, readable by its owner only.

        That guards a copied or backed-up key file, not the account itself: enough for a demonstration, and
        the reason why every name in here says that it is one.
        """
        if self._given is not None:
            if not self._given:
                raise InputError("A key is only kept under a passphrase: give one that is not empty")
            return self._given
        path = self.folder / _PASSPHRASE_FILE
        if not path.is_file():
            _write_private(path, secrets.token_urlsafe(32).encode())
        return _read(path).decode("ascii", "replace")

    def _person_file(self, person_id: str) -> Path:
        if not _PERSON_ID.fullmatch(person_id) or person_id.strip(".") == "":
            raise InputError("“{person}” cannot be used as a person's key name", person=person_id)
        return self.folder / _PEOPLE / f"{person_id}.p12"

    def _open(self) -> tuple[EllipticCurvePrivateKey, x509.Certificate]:
        from cryptography import x509
        from cryptography.hazmat.primitives.asymmetric.ec import EllipticCurvePrivateKey
        from cryptography.hazmat.primitives.serialization import load_pem_private_key

        path = self.folder / _ROOT_KEY_FILE
        try:
            key = load_pem_private_key(_read(path), self._passphrase().encode())
            root = x509.load_pem_x509_certificate(_read(self.folder / _ROOT_FILE))
        except (ValueError, TypeError) as error:
            raise InputError(
                "The authority in {folder} cannot be opened: wrong passphrase or damaged file",
                folder=self.folder,
            ) from error
        if not isinstance(key, EllipticCurvePrivateKey):
            raise InputError("{path} is not the key of a demonstration authority", path=path)
        return key, root


# ── certificates ─────────────────────────────────────────────────────────────────────────────────────────


def _subject(name: str) -> x509.Name:
    from cryptography import x509
    from cryptography.x509.oid import NameOID

    return x509.Name(
        [
            x509.NameAttribute(NameOID.ORGANIZATION_NAME, ORGANISATION),
            x509.NameAttribute(NameOID.COMMON_NAME, name),
        ]
    )


def _usage(*, authority: bool) -> x509.KeyUsage:
    from cryptography import x509

    return x509.KeyUsage(
        digital_signature=not authority,
        content_commitment=not authority,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=authority,
        crl_sign=authority,
        encipher_only=False,
        decipher_only=False,
    )


def _root_certificate(key: EllipticCurvePrivateKey, now: datetime) -> x509.Certificate:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    name = _subject(ROOT_NAME)
    return (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(now + timedelta(days=365 * _ROOT_YEARS))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(authority=True), critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .sign(key, hashes.SHA256())
    )


def _person_certificate(
    key: EllipticCurvePrivateKey,
    name: str,
    root_key: EllipticCurvePrivateKey,
    root: x509.Certificate,
    now: datetime,
) -> x509.Certificate:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    marked = name if "demonstration" in name.lower() else f"{name} (Demonstration)"
    if not name.strip() or len(marked) > 64:
        raise InputError("A signing certificate needs a name of 1 to 48 characters, not “{name}”", name=name)
    return (
        x509.CertificateBuilder()
        .subject_name(_subject(marked))
        .issuer_name(root.subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(min(now + timedelta(days=365 * _PERSON_YEARS), root.not_valid_after_utc))
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(authority=False), critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(root_key.public_key()), critical=False
        )
        .sign(root_key, hashes.SHA256())
    )


def _revocation_list(key: EllipticCurvePrivateKey, root: x509.Certificate, now: datetime) -> bytes:
    """An empty list that holds as long as the root, so that signatures can be checked offline for good."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes
    from cryptography.hazmat.primitives.serialization import Encoding

    return (
        x509.CertificateRevocationListBuilder()
        .issuer_name(root.subject)
        .last_update(now - timedelta(days=1))
        .next_update(root.not_valid_after_utc)
        .add_extension(x509.CRLNumber(1), critical=False)
        .add_extension(x509.AuthorityKeyIdentifier.from_issuer_public_key(key.public_key()), critical=False)
        .sign(key, hashes.SHA256())
        .public_bytes(Encoding.DER)
    )


# ── files ────────────────────────────────────────────────────────────────────────────────────────────────


def _pkcs12_encryption(password: str) -> KeySerializationEncryption:
    from cryptography.hazmat.primitives.hashes import SHA256
    from cryptography.hazmat.primitives.serialization import PrivateFormat, pkcs12

    if not password:
        raise InputError("A key is only kept under a passphrase: give one that is not empty")
    return (
        PrivateFormat.PKCS12.encryption_builder()
        .kdf_rounds(_KDF_ROUNDS)
        .key_cert_algorithm(pkcs12.PBES.PBESv2SHA256AndAES256CBC)
        .hmac_hash(SHA256())
        .build(password.encode())
    )


def _read(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST_IDENTITY + 1)
    except OSError as error:
        raise InputError(
            "{path} cannot be read ({reason})", path=path, reason=error.strerror or error
        ) from error
    if len(data) > _LARGEST_IDENTITY:
        raise InputError("{path} is too large to be a key or a certificate", path=path)
    return data


def _write_private(path: Path, data: bytes) -> None:
    """Readable by its owner only, and never half written."""
    partial = path.with_name(path.name + ".part")
    with os.fdopen(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
        file.write(data)
    partial.replace(path)


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise MachineError(
            "Keys cannot be written to {folder} ({reason}): choose another folder or make room",
            folder=folder,
            reason=error.strerror or error,
        ) from error
