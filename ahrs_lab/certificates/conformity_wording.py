"""The fixed words of the statement of conformity, Chinese and English side by side."""

from __future__ import annotations

from ahrs_lab.certificates.documents import Words
from ahrs_lab.metrology.conformity import RuleKind

CONFORMITY = Words("符合性判定", "Statement of conformity")
SUMMARY = Words(
    "按判定规则“{rule}”，{count} 项参数与客户限值比较，判定结果：{verdict}。",
    "By the decision rule “{rule}”, {count} values against the customer's limits: {verdict}.",
)
MISSING = Words(
    "{keys} 有限值但未校准，不作判定。", "{keys}: limits were set, but not calibrated; not judged."
)
LOW = Words("下限", "Low")
HIGH = Words("上限", "High")
UNIT = Words("单位", "Unit")
ACCEPTED = Words("接受区间", "Acceptance")
PROBABILITY = Words("符合概率 p_{c}", "p_{c}")
VERDICT = Words("判定", "Verdict")

RULES: dict[RuleKind, Words] = {
    "simple": Words(
        "判定规则：{rule}，w = 0。校准值在限值以内（含限值）为合格，否则为不合格；合格判定的误接受"
        "风险最大为 {risk}。",
        "Decision rule: {rule}, w = 0. A value within its limits (or on one) passes, any other fails; the "
        "risk of false acceptance is up to {risk}.",
    ),
    "guard-band": Words(
        "判定规则：{rule}。校准值距限值不小于 w 且在限值以内为合格，否则为不合格；合格判定的误接受风险最大为 "
        "{risk}。",
        "Decision rule: {rule}. A value that lies within its limits by w or more passes, any other fails; "
        "the risk of false acceptance is up to {risk}.",
    ),
    "non-binary": Words(
        "判定规则：{rule}。校准值在限值以内且距限值不小于 w 为合格；在限值以内但距限值小于 w 为有条件合格；"
        "超出限值不多于 w 为有条件不合格；超出更多为不合格。合格判定的误接受风险最大为 {risk}。",
        "Decision rule: {rule}. Pass: within the limits by w or more; conditional pass: within the limits, "
        "but by less than w; conditional fail: beyond a limit by no more than w; fail: further beyond. The "
        "risk of false acceptance of an unconditional pass is up to {risk}.",
    ),
}
BEFORE_ROUNDING = Words("判定使用修约前的校准值和 U。", "Judged by value and U before rounding.")
PROBABILITY_NOTE = Words(
    "p_{c}：被测量处于限值以内的概率（JCGM 106），由校准值、u_{c} 和有效自由度按 t 分布求得，不含先验信息；"
    "判为合格时误接受风险为 1 − p_{c}，判为不合格时误拒绝风险为 p_{c}。",
    "p_{c}: probability that the quantity lies within its limits (JCGM 106), from value, u_{c} and effective "
    "degrees of freedom by the t-distribution, without prior knowledge. The risk is 1 − p_{c} of falsely "
    "accepting what passes, p_{c} of falsely rejecting what fails.",
)
RELATIVE = Words(
    "{keys}：以相对标称值 {nominal} {unit} 的偏差表示。",
    "{keys}: as deviation from the nominal value {nominal} {unit}.",
)

# Expression of results
DEVIATION = Words("K − 1", "K − 1")
RATIO_IN_ONE_UNIT = Words(
    "规范称失准角的单位为度，而式 (7) 得出比值，小角度时即弧度；此处按约定的单位给出。",
    "The standard calls L an angle in degrees, but (7) yields a ratio, which for small angles is in "
    "radians; given in the unit agreed.",
)
RAISED = Words(
    "计算所得 U 小于本实验室声明的最佳测量能力（CMC，k = 2），按 CMC 给出；不确定度汇总所列为计算值。",
    "The computed U is smaller than the laboratory's best measurement capability (CMC, k = 2), which is "
    "stated instead; the uncertainty summary shows what was computed.",
)
