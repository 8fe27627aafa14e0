"""The last touch on a document before it may be signed: what the file says of itself, and empty signature
fields.

After the first signature nothing may ever be saved again, so all of this comes before.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ahrs_lab.certificates.documents import DocumentFrame
from ahrs_lab.certificates.richtext import text_of
from ahrs_lab.certificates.stamp import waiting_pdf

if TYPE_CHECKING:
    import pikepdf

    from ahrs_lab.certificates.layout import SignaturePlace

_LANGUAGES = {"bilingual": "zh-CN", "zh": "zh-CN", "en": "en"}
_PRINT_AND_LOCKED = 4 + 128


def finished(data: bytes, places: Sequence[SignaturePlace], frame: DocumentFrame) -> bytes:
    """``data`` with title, author, language and one empty signature field a place; the same for the same
    input."""
    import pikepdf

    buffer = io.BytesIO()
    with pikepdf.open(io.BytesIO(data)) as pdf:
        _describe(pdf, frame)
        if places:
            _add_fields(pdf, places, frame)
        pdf.save(
            buffer,
            deterministic_id=True,
            min_version="1.7",
            object_stream_mode=pikepdf.ObjectStreamMode.disable,
        )
    return buffer.getvalue()


def _describe(pdf: pikepdf.Pdf, frame: DocumentFrame) -> None:
    import pikepdf

    author = text_of(frame.laboratory.main)
    # pyHanko writes a producer of its own at signing, which would count as a change if there were one
    # already.
    for key in list(pdf.docinfo.keys()):
        del pdf.docinfo[key]
    pdf.docinfo["/Title"] = frame.file_title
    pdf.docinfo["/Author"] = author
    pdf.docinfo["/Subject"] = frame.file_subject
    # For the stamps: /Lang cannot tell a bilingual certificate from a Chinese one.
    pdf.docinfo["/CertificateLanguage"] = frame.language
    with pdf.open_metadata(set_pikepdf_as_editor=False) as xmp:
        xmp["dc:title"] = frame.file_title
        xmp["dc:creator"] = [author]
        xmp["dc:description"] = frame.file_subject
        xmp["dc:language"] = [_LANGUAGES[frame.language]]
    pdf.Root.Lang = pikepdf.String(_LANGUAGES[frame.language])
    pdf.Root.ViewerPreferences = pikepdf.Dictionary(DisplayDocTitle=True)


def _add_fields(pdf: pikepdf.Pdf, places: Sequence[SignaturePlace], frame: DocumentFrame) -> None:
    """Fields named by role; the approver's locks the document (ISO 32000-1, 12.7.4.5)."""
    import pikepdf

    fields = pikepdf.Array()
    for place in places:
        page = pdf.pages[place.page]
        widget = pikepdf.Dictionary(
            Type=pikepdf.Name.Annot,
            Subtype=pikepdf.Name.Widget,
            FT=pikepdf.Name.Sig,
            T=pikepdf.String(place.role),
            Rect=pikepdf.Array([round(value, 3) for value in place.box]),
            F=_PRINT_AND_LOCKED,
            P=page.obj,
        )
        left, bottom, right, top = place.box
        widget.AP = pikepdf.Dictionary(N=_waiting(pdf, (right - left, top - bottom), frame))
        if place.role == "approver":
            widget.Lock = pikepdf.Dictionary(Type=pikepdf.Name.SigFieldLock, Action=pikepdf.Name.All)
        field = pdf.make_indirect(widget)
        fields.append(field)
        if "/Annots" not in page.obj:
            page.obj.Annots = pikepdf.Array()
        page.obj.Annots.append(field)
    pdf.Root.AcroForm = pikepdf.Dictionary(Fields=fields, SigFlags=3)


def _waiting(pdf: pikepdf.Pdf, size: tuple[float, float], frame: DocumentFrame) -> pikepdf.Object:
    """The appearance of an empty field, as a form of ``pdf``."""
    import pikepdf

    with pikepdf.open(io.BytesIO(waiting_pdf(size, frame.language))) as waiting:
        return pdf.copy_foreign(waiting.pages[0].as_form_xobject())
