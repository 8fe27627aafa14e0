"""The widgets all pages are made of. Texts come from the page; these only know how things look."""

from ahrs_lab.ui.widgets.banner import Banner
from ahrs_lab.ui.widgets.buttons import (
    DangerButton,
    IconButton,
    LinkButton,
    PrimaryButton,
    QuietButton,
    SecondaryButton,
    repolish,
)
from ahrs_lab.ui.widgets.card import Card, Panel
from ahrs_lab.ui.widgets.empty_state import EmptyState
from ahrs_lab.ui.widgets.key_value_table import KeyValueTable
from ahrs_lab.ui.widgets.labels import ElidedLabel, Label, Line, LineSwatch, MarkedLabel, Swatch
from ahrs_lab.ui.widgets.progress import ProgressBar
from ahrs_lab.ui.widgets.segmented_switch import SegmentedSwitch
from ahrs_lab.ui.widgets.state_dot import State, StateDot, StateIcon
from ahrs_lab.ui.widgets.values import BigNumber, ValueLabel

__all__ = [
    "Banner",
    "BigNumber",
    "Card",
    "DangerButton",
    "ElidedLabel",
    "EmptyState",
    "IconButton",
    "KeyValueTable",
    "Label",
    "Line",
    "LineSwatch",
    "LinkButton",
    "MarkedLabel",
    "Panel",
    "PrimaryButton",
    "ProgressBar",
    "QuietButton",
    "SecondaryButton",
    "SegmentedSwitch",
    "State",
    "StateDot",
    "StateIcon",
    "Swatch",
    "ValueLabel",
    "repolish",
]
