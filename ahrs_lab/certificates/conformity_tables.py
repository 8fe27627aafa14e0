"""The statement of conformity: value, limits, verdict of each quantity, each in its limit's unit, and the
rule by which it was judged."""

from __future__ import annotations

import math
from collections.abc import Iterable
from decimal import Decimal

from ahrs_lab.certificates import conformity_wording as said
from ahrs_lab.certificates import wording
from ahrs_lab.certificates.documents import (
    LATIN_MARKS,
    Block,
    Column,
    Heading,
    Label,
    Paragraph,
    Table,
    Words,
    both,
    label,
    same,
)
from ahrs_lab.certificates.result_tables import DASH, ResultWriter, unit_text
from ahrs_lab.certificates.richtext import RichText, markup, symbol, text_of
from ahrs_lab.messages import Message
from ahrs_lab.metrology.conformity import VERDICT_NAMES, Conformity, Statement, Verdict
from ahrs_lab.metrology.limits import measured
from ahrs_lab.metrology.result import CalibrationResult
from ahrs_lab.metrology.rounding import format_grouped, round_to_place, round_to_uncertainty

_NOTE_SIZE = 7.0


def conformity_blocks(
    conformity: Conformity, result: CalibrationResult, writer: ResultWriter
) -> tuple[Block, ...]:
    """Summary, table, and the rule as a footnote."""
    blocks: list[Block] = [Heading(writer.words(said.CONFORMITY))]
    if conformity.statements:
        blocks += [Paragraph(_summary(conformity, writer), together=True), _table(conformity, writer)]
    if conformity.missing:
        blocks.append(Paragraph(_of_keys(said.MISSING, conformity.missing, writer), together=True))
    notes = _notes(conformity, result, writer)
    return (
        *blocks,
        *(
            Paragraph(note, size=_NOTE_SIZE, together=True, kept=number < len(notes))
            for number, note in enumerate(notes, 1)
        ),
    )


def _words(words: Words, **values: Message | str) -> Words:
    """Filled with what is said in each language."""
    filled = {
        language: {
            key: value.text(language) if isinstance(value, Message) else value
            for key, value in values.items()
        }
        for language in ("zh", "en")
    }
    return Words(words.zh.format(**filled["zh"]), words.en.format(**filled["en"]))


def _summary(conformity: Conformity, writer: ResultWriter) -> Label:
    verdict = VERDICT_NAMES[conformity.verdict]
    count = str(len(conformity.statements))
    words = _words(said.SUMMARY, rule=conformity.rule.name(), count=count, verdict=verdict)
    return writer.words(words)


def _table(conformity: Conformity, writer: ResultWriter) -> Table:
    rule = conformity.rule
    columns = [
        Column(writer.words(wording.QUANTITY)),
        writer.column(wording.VALUE, strong=True),
        writer.column(wording.EXPANDED_SHORT),
        writer.column(said.LOW),
        writer.column(said.HIGH),
    ]
    if rule.kind != "simple":
        columns.append(writer.column(said.ACCEPTED))
    columns.append(Column(writer.words(said.UNIT)))
    if rule.probability:
        columns.append(writer.column(said.PROBABILITY))
    columns.append(Column(writer.words(said.VERDICT), strong=True))
    return Table(tuple(columns), tuple(_row(one, writer) for one in conformity.statements))


def _row(one: Statement, writer: ResultWriter) -> tuple[Label, ...]:
    rounded = round_to_uncertainty(one.value, one.expanded, writer.rounding)
    cells = [
        Label(_symbol(one.key)),
        same(format_grouped(rounded.value)),
        same(format_grouped(rounded.expanded)),
        same(_bound(one.limit.low)),
        same(_bound(one.limit.high)),
    ]
    if one.rule.kind != "simple":
        accepted = _acceptance(one, rounded.decimals)
        cells.append(same(accepted.translate(LATIN_MARKS) if writer.language == "en" else accepted))
    cells.append(Label(markup(one.limit.kind.label)))
    if one.rule.probability:
        cells.append(same(probability_text(one.conformance)))
    return (*cells, _verdict(one.verdict, writer))


def _symbol(key: str) -> RichText:
    letter, _, index = key.partition("_")
    return symbol(letter, index)


def _bound(bound: float | None) -> str:
    """As it was agreed: all its digits."""
    return DASH if bound is None else format_grouped(format(Decimal(repr(bound)).normalize(), "f"))


def _acceptance(one: Statement, decimals: int) -> str:
    low, high = (
        None if end is None else format_grouped(round_to_place(end, decimals)) for end in one.acceptance
    )
    if low is None:
        return f"≤ {high}"
    return f"≥ {low}" if high is None else f"{low} … {high}"


def _verdict(verdict: Verdict, writer: ResultWriter) -> Label:
    name = VERDICT_NAMES[verdict]
    return both(name.text("zh"), name.text("en"), writer.language)


def probability_text(probability: float) -> str:
    """In per cent with one decimal; never 0 % or 100 %, which no measurement yields."""
    if probability > 0.9995:
        return "> 99.9 %"
    return "< 0.1 %" if probability < 0.001 else f"{100.0 * probability:.1f} %"


def _risk(conformity: Conformity) -> str:
    """The largest of all in per cent, two digits, rounded up."""
    worst = float(f"{100.0 * max(one.largest_false_accept for one in conformity.statements):.9g}")
    if worst < 0.01:
        return "0.01 %"
    return f"{round_to_place(worst, 1 - math.floor(math.log10(worst)), 'up')} %"


def _notes(conformity: Conformity, result: CalibrationResult, writer: ResultWriter) -> list[Label]:
    if not conformity.statements:
        return []
    rule = conformity.rule
    parts = [_words(said.RULES[rule.kind], rule=rule.name(), risk=_risk(conformity)), said.BEFORE_ROUNDING]
    notes = [writer.words(Words("".join(one.zh for one in parts), " ".join(one.en for one in parts)))]
    if rule.probability:
        notes.append(writer.words(said.PROBABILITY_NOTE))
    units = {one.key: one.unit for one in measured(result)}
    nominals: dict[tuple[float, str], list[str]] = {}
    for one in conformity.statements:
        if one.limit.nominal is not None:
            nominals.setdefault((one.limit.nominal, units[one.key]), []).append(one.key)
    for (nominal, unit), keys in nominals.items():
        notes.append(_of_keys(said.RELATIVE, keys, writer, nominal=_bound(nominal), unit=_plain_unit(unit)))
    return notes


def _plain_unit(unit: str) -> str:
    return text_of(unit_text(unit))


def _of_keys(words: Words, keys: Iterable[str], writer: ResultWriter, **values: str) -> Label:
    named = ", ".join(f"{key[0]}_{{{key[2:]}}}" for key in keys)
    return label(words.filled(keys=named, **values), writer.language)
