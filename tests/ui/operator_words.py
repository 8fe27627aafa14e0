"""What the operator reads and presses, in both languages: literals, so that a changed text is noticed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

Language = Literal["en", "zh"]


@dataclass(frozen=True)
class Words:
    """What stands on the buttons and in the sentences of one language."""

    language: Language
    other_language: str
    """The button of the other one."""
    prepare: str
    begin: str
    mount_up: str
    mount_down: str
    directions: dict[str, str]
    mounted: str
    noted: str
    done: str
    show_results: str
    certificate: str
    values: str
    findings: str
    preview: str
    sign_operator: str
    sign_in_as: str
    sign_verifier: str
    sign_approver: str
    password: str
    sign_in: str
    sign: str
    password_of: str
    signed: str
    intact: str
    verify_again: str
    theme: str
    dark: str
    light: str
    run: str
    start: str
    issued: str
    stopped: str
    stopped_why: str
    at_rest: str
    resume: str
    failed: str
    fault_told: tuple[str, ...]
    refused: tuple[str, ...]
    pausing: str
    paused: str
    pause_told: str
    go_on: str
    repeat: str
    segment: str
    reason: str
    typed_reason: str
    record_again: str
    repeated_step: str
    nothing_to_stop: str
    known: frozenset[str]
    """Words of the other language that belong here: names, units, keys."""


EN = Words(
    language="en",
    other_language="中文",
    prepare="Prepare and start",
    begin="Start calibration",
    mount_up="Mount the case with {axis} pointing up",
    mount_down="Mount the case with {axis} pointing down",
    directions={"E": "east", "N": "north", "U": "up", "W": "west", "S": "south", "D": "down"},
    mounted="Mounted",
    noted="Noted",
    done="The run is complete",
    show_results="Show the results",
    certificate="Certificate preview",
    values="Values",
    findings="Warnings and deviations",
    preview="A preview: nothing is signed yet.",
    sign_operator="Certify and sign",
    sign_in_as="Sign in as this person",
    sign_verifier="Checked: sign",
    sign_approver="Approve and issue",
    password="Password",
    sign_in="Sign in",
    sign="Sign",
    password_of="Password of {name}",
    signed="signed",
    intact="Intact and unchanged since the last signature",
    verify_again="Verify again",
    theme="Light or dark",
    dark="Dark",
    light="Light",
    run="Run",
    start="Start",
    issued="Issued last",
    stopped="The run was stopped",
    stopped_why="Stopped by the operator.",
    at_rest="The table rests, the supply is off. What was recorded is kept.",
    resume="Resume the run",
    failed="The run could not go on",
    fault_told=("drive tripped: axis limit", "Find its cause, then start the run again"),
    refused=("Asked: X up.", "The sensor feels", "tilt 90.0°", "Turn the case so that X points up."),
    pausing="Pausing after this …",
    paused="Paused",
    pause_told="The table rests and the supply stays on until you go on.",
    go_on="Go on",
    repeat="Repeat a segment …",
    segment="Zero offset of Z, position 1",
    reason="Reason",
    typed_reason="somebody leant on the table",
    record_again="Record it again",
    repeated_step="Z zero offset, NUE",
    nothing_to_stop="No run is going on: there is nothing to stop.",
    known=frozenset({"中文"}),
)
ZH = Words(
    language="zh",
    other_language="EN",
    prepare="准备并开始",
    begin="开始校准",
    mount_up="装夹机壳，使 {axis} 轴朝天",
    mount_down="装夹机壳，使 {axis} 轴朝地",
    directions={"E": "东", "N": "北", "U": "天", "W": "西", "S": "南", "D": "地"},
    mounted="已装夹",
    noted="已确认",
    done="校准运行完成",
    show_results="查看结果",
    certificate="证书预览",
    values="数值",
    findings="警告与偏离",
    preview="预览：尚未签名。",
    sign_operator="确认并签名",
    sign_in_as="以此人登录",
    sign_verifier="核验并签名",
    sign_approver="批准并签发",
    password="密码",
    sign_in="登录",
    sign="签名",
    password_of="{name}的密码",
    signed="已签名",
    intact="完整，自最后一次签名后未被改动",
    verify_again="重新验证",
    theme="浅色或深色",
    dark="深色",
    light="浅色",
    run="运行",
    start="首页",
    issued="最近签发",
    stopped="运行已停止",
    stopped_why="由校准员停止。",
    at_rest="转台已静止，电源已断开。已记录的数据均已保留。",
    resume="继续运行",
    failed="运行无法继续",
    fault_told=("drive tripped: axis limit", "请查明原因"),
    refused=("要求：X 轴朝天。", "传感器感受到", "倾斜 90.0°", "请翻转，使 X 轴朝天。"),
    pausing="本步之后暂停…",
    paused="已暂停",
    pause_told="在您继续之前，转台静止，电源保持接通。",
    go_on="继续",
    repeat="重测某一数据段…",
    segment="Z 轴零偏，位置 1",
    reason="理由",
    typed_reason="有人碰到了转台",
    record_again="重新记录",
    repeated_step="Z 零偏 北天东",
    nothing_to_stop="没有正在进行的运行，无需停止。",
    known=frozenset(
        re.findall(
            r"\S+",
            "min JJF JCGM ILAC AHRS GUM CSV Esc pdf ppm rad English DEMO zero_offset.duration_s "
            "Lyx Lzx Lxy Lzy Lxz Lyz",
        )
    ),
)
BOTH_SCRIPTS = frozenset(
    re.findall(r"[A-Za-z]+", "Demonstration Customer Ltd Example Road Strapdown AHRS Inertial laboratory")
) | {"演示客户有限公司", "演示市示例路", "号", "捷联式惯性航姿仪", "惯性实验室"}
"""Of the order form, which shows the names in both."""
STOP = {"en": "STOP", "zh": "停止"}
NAMES = {
    "en": ("Demo operator", "Demo verifier", "Demo approver"),
    "zh": ("演示校准员", "演示核验员", "演示签发人"),
}
