"""The look: palettes light and dark, the three font sizes, spacing in steps of 4, the style sheet made of
them.

Colours have names of purpose (:class:`Tokens`). A widget that paints asks :func:`tokens` each time, which
follows the application's palette, so that nothing has to be told when the theme changes: Qt repaints it
anyway. Green, amber and red stand for state only, always beside a word or an icon.
"""

from __future__ import annotations

from dataclasses import dataclass
from string import Template
from typing import Literal, get_args

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QColor, QFont, QFontDatabase, QGuiApplication, QPalette
from PySide6.QtWidgets import QApplication

from ahrs_lab.errors import MachineError
from ahrs_lab.recording.orientation import Axis
from ahrs_lab.resource_files import resource_path

ThemeMode = Literal["light", "dark", "system"]
THEME_MODES: tuple[ThemeMode, ...] = get_args(ThemeMode)

FontRole = Literal["text", "strong", "title", "number"]

STEP = 4
"""Spacing comes in multiples of this many pixels at scale 1."""
GAP = 2 * STEP
CARD_MARGIN = 3 * STEP
RADIUS = 6

TEXT_PX = 13
TITLE_PX = 20
NUMBER_PX = 30
"""The only font sizes there are."""

AXIS_COLOURS: dict[Axis, str] = {"x": "#D55E00", "y": "#009E73", "z": "#0072B2"}
"""Vermilion, bluish green, blue: told apart by colour-blind eyes, the same in both themes."""
AXIS_PENS: dict[Axis, Qt.PenStyle] = {
    "x": Qt.PenStyle.SolidLine,
    "y": Qt.PenStyle.DashLine,
    "z": Qt.PenStyle.DotLine,
}


@dataclass(frozen=True)
class Tokens:
    """The colours of one theme, named by what they are for."""

    dark: bool
    page: str
    card: str
    rail: str
    line: str
    hover: str
    text: str
    muted: str
    faint: str
    accent: str
    accent_hover: str
    on_accent: str
    accent_soft: str
    good: str
    good_soft: str
    warn: str
    warn_soft: str
    bad: str
    bad_soft: str
    stop: str
    stop_hover: str
    on_stop: str
    metal: str
    metal_edge: str
    case: str

    def colour(self, name: str) -> QColor:
        """The colour called ``name``."""
        return QColor(getattr(self, name))


LIGHT = Tokens(
    dark=False,
    page="#F4F6FA",
    card="#FFFFFF",
    rail="#FFFFFF",
    line="#E1E5EC",
    hover="#EEF1F6",
    text="#182030",
    muted="#5D687A",
    faint="#98A2B3",
    accent="#2463EB",
    accent_hover="#1D53CB",
    on_accent="#FFFFFF",
    accent_soft="#EAF1FE",
    good="#0F7B55",
    good_soft="#E1F3EB",
    warn="#946200",
    warn_soft="#FDF2D6",
    bad="#C5282F",
    bad_soft="#FCE7E7",
    stop="#D0323A",
    stop_hover="#B7272F",
    on_stop="#FFFFFF",
    metal="#DDE2EA",
    metal_edge="#AEB7C4",
    case="#4C7FF0",
)
DARK = Tokens(
    dark=True,
    page="#11151B",
    card="#1A1F27",
    rail="#151A21",
    line="#2B323D",
    hover="#242B35",
    text="#E7EAF0",
    muted="#9AA5B6",
    faint="#697486",
    accent="#7AA2FF",
    accent_hover="#94B4FF",
    on_accent="#0C1322",
    accent_soft="#20304F",
    good="#45BE8C",
    good_soft="#15322A",
    warn="#E3AE4A",
    warn_soft="#382D16",
    bad="#F0727A",
    bad_soft="#3D2024",
    stop="#D5363F",
    stop_hover="#E9555D",
    on_stop="#FFFFFF",
    metal="#39424F",
    metal_edge="#5B6675",
    case="#4A78DC",
)


def tokens() -> Tokens:
    """The colours of the theme that is on."""
    return DARK if QGuiApplication.palette().color(QPalette.ColorRole.Window).lightness() < 128 else LIGHT


def register_fonts() -> str:
    """Make the bundled fonts known and return their family; raises MachineError where they are missing,
    because Chinese would be boxes."""
    families: list[str] = []
    for path in sorted(resource_path("fonts").glob("*.ttf")):
        number = QFontDatabase.addApplicationFont(str(path))
        families += QFontDatabase.applicationFontFamilies(number)
    if not families:
        raise MachineError(
            "The application's fonts are missing in {folder}: install it again, or fetch the whole "
            "repository.",
            folder=str(resource_path("fonts")),
        )
    return families[0]


def font(role: FontRole = "text") -> QFont:
    """The application's font in one of its sizes, with digits of equal width."""
    result = QFont(QGuiApplication.font())
    result.setPixelSize({"text": TEXT_PX, "strong": TEXT_PX, "title": TITLE_PX, "number": NUMBER_PX}[role])
    result.setWeight(QFont.Weight.Normal if role == "text" else QFont.Weight.Bold)
    return result


class ThemeSwitch(QObject):
    """Applies a theme to the application and keeps "system" following the desktop. One per application."""

    def __init__(self, app: QApplication, mode: ThemeMode = "system") -> None:
        super().__init__(app)
        self._app = app
        self._mode = mode
        app.setStyle("Fusion")
        _set_font(app)
        app.styleHints().colorSchemeChanged.connect(self._system_changed)
        self.set_mode(mode)

    @property
    def mode(self) -> ThemeMode:
        """What the person chose."""
        return self._mode

    @property
    def dark(self) -> bool:
        """Dark is on, chosen or by the system."""
        return tokens().dark

    def set_mode(self, mode: ThemeMode) -> None:
        """Switch now."""
        self._mode = mode
        schemes = {
            "light": Qt.ColorScheme.Light,
            "dark": Qt.ColorScheme.Dark,
            "system": Qt.ColorScheme.Unknown,
        }
        self._app.styleHints().setColorScheme(schemes[mode])
        self._apply()

    def _system_changed(self, _scheme: Qt.ColorScheme) -> None:
        if self._mode == "system":
            self._apply()

    def _apply(self) -> None:
        dark = self._mode == "dark" or (
            self._mode == "system" and self._app.styleHints().colorScheme() == Qt.ColorScheme.Dark
        )
        chosen = DARK if dark else LIGHT
        self._app.setPalette(palette(chosen))
        self._app.setStyleSheet(style_sheet(chosen))


def _set_font(app: QApplication) -> None:
    family = register_fonts()
    chosen = QFont(family)
    chosen.setPixelSize(TEXT_PX)
    chosen.setFeature(QFont.Tag("tnum"), 1)
    chosen.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    app.setFont(chosen)


def palette(chosen: Tokens) -> QPalette:
    """Qt's palette of these colours."""
    result = QPalette()
    role = QPalette.ColorRole
    colours = {
        role.Window: chosen.page,
        role.WindowText: chosen.text,
        role.Base: chosen.card,
        role.AlternateBase: chosen.hover,
        role.Text: chosen.text,
        role.PlaceholderText: chosen.faint,
        role.Button: chosen.card,
        role.ButtonText: chosen.text,
        role.BrightText: chosen.bad,
        role.Highlight: chosen.accent,
        role.HighlightedText: chosen.on_accent,
        role.Accent: chosen.accent,
        role.Link: chosen.accent,
        role.LinkVisited: chosen.accent,
        role.ToolTipBase: chosen.text,
        role.ToolTipText: chosen.card,
        role.Light: chosen.hover,
        role.Midlight: chosen.hover,
        role.Mid: chosen.line,
        role.Dark: chosen.metal_edge,
        role.Shadow: chosen.line,
    }
    for key, colour in colours.items():
        result.setColor(key, QColor(colour))
    for key in (role.WindowText, role.Text, role.ButtonText):
        result.setColor(QPalette.ColorGroup.Disabled, key, QColor(chosen.faint))
    return result


def style_sheet(chosen: Tokens) -> str:
    """What Fusion does not do by its palette."""
    values = {name: getattr(chosen, name) for name in Tokens.__dataclass_fields__ if name != "dark"}
    return Template(_STYLE).substitute(values, radius=RADIUS)


_STYLE = """
QToolTip { background: $text; color: $card; border: none; padding: 4px 8px; }
QLabel { background: transparent; }
QLabel[plate="true"] { background: $card; padding: 0 4px; }
QLabel[tone="muted"] { color: $muted; }
QLabel[tone="faint"] { color: $faint; }
QLabel[tone="accent"] { color: $accent; }
QLabel[tone="good"] { color: $good; }
QLabel[tone="warn"] { color: $warn; }
QLabel[tone="bad"] { color: $bad; }
QLabel[tone="axis_x"] { color: #D55E00; }
QLabel[tone="axis_y"] { color: #009E73; }
QLabel[tone="axis_z"] { color: #0072B2; }

QFrame#card { background: $card; border: 1px solid $line; border-radius: ${radius}px; }
QFrame#rail { background: $rail; border: none; border-right: 1px solid $line; }
QFrame#contextBar { background: $rail; border: none; border-bottom: 1px solid $line; }
QFrame#healthStrip { background: $rail; border: none; border-top: 1px solid $line; }
QFrame#stopBar { background: $rail; border: none; border-top: 1px solid $line; }
QFrame#line { background: $line; border: none; }
QFrame[panel="plain"] { background: $hover; border: none; border-radius: ${radius}px; }
QFrame[panel="accent"] { background: $accent_soft; border: none; border-radius: ${radius}px; }
QFrame[panel="good"] { background: $good_soft; border: none; border-radius: ${radius}px; }
QFrame[panel="warn"] { background: $warn_soft; border: none; border-radius: ${radius}px; }
QFrame[panel="bad"] { background: $bad_soft; border: none; border-radius: ${radius}px; }

QPushButton { background: $card; color: $text; border: 1px solid $line; border-radius: ${radius}px;
    padding: 5px 12px; min-height: 20px; }
QPushButton:hover { background: $hover; }
QPushButton:pressed { background: $line; }
QPushButton:disabled { color: $faint; }
QPushButton:focus { border: 1px solid $accent; }
QPushButton[kind="primary"] { background: $accent; color: $on_accent; border: 1px solid $accent;
    font-weight: 700; }
QPushButton[kind="primary"]:hover { background: $accent_hover; border-color: $accent_hover; }
QPushButton[kind="primary"]:focus { border: 2px solid $text; padding: 4px 11px; }
QPushButton[kind="primary"]:disabled { background: $line; color: $faint; border-color: $line; }
QPushButton[kind="danger"] { color: $bad; border-color: $bad; }
QPushButton[kind="stop"] { background: $stop; color: $on_stop; border: 1px solid $stop; font-weight: 700; }
QPushButton[kind="stop"]:hover { background: $stop_hover; border-color: $stop_hover; }
QPushButton[kind="stop"]:focus { border: 2px solid $text; padding: 4px 11px; }
QPushButton[kind="quiet"] { background: transparent; border: 1px solid transparent; color: $muted;
    padding: 3px 8px; }
QPushButton[kind="quiet"]:hover { background: $hover; color: $text; }
QPushButton[kind="quiet"]:focus { border: 1px solid $accent; }
QPushButton[kind="quiet"]:checked { background: $accent_soft; color: $accent; }
QPushButton[kind="quiet"]:disabled { color: $faint; }
QPushButton[kind="link"] { background: transparent; border: none; color: $accent; padding: 0;
    text-align: left; }
QPushButton[kind="link"]:hover { color: $accent_hover; text-decoration: underline; }
QPushButton::menu-indicator { width: 0; }

QLineEdit, QPlainTextEdit, QTextEdit, QComboBox, QAbstractSpinBox { background: $card; color: $text;
    border: 1px solid $line; border-radius: ${radius}px; padding: 4px 8px; min-height: 20px;
    selection-background-color: $accent; selection-color: $on_accent; }
QLineEdit:focus, QPlainTextEdit:focus, QTextEdit:focus, QComboBox:focus, QAbstractSpinBox:focus {
    border: 1px solid $accent; }
QLineEdit:disabled, QComboBox:disabled, QAbstractSpinBox:disabled { color: $faint; background: $page; }
QLineEdit[invalid="true"], QComboBox[invalid="true"] { border: 1px solid $bad; }
QComboBox::drop-down { border: none; width: 20px; }
QComboBox QAbstractItemView { background: $card; border: 1px solid $line; padding: 4px; outline: none; }

QTreeView, QTableView, QListView { background: transparent; border: none; outline: none;
    alternate-background-color: $page; selection-background-color: $accent_soft; selection-color: $text; }
QTableView { gridline-color: $line; }
QTableView::item, QListView::item { padding: 4px 8px; border: none; }
QTableView::item:hover, QListView::item:hover { background: $hover; }
QTableView::item:selected, QListView::item:selected { background: $accent_soft; color: $text; }
QHeaderView { background: transparent; border: none; }
QHeaderView::section { background: transparent; color: $muted; border: none; border-bottom: 1px solid $line;
    padding: 6px 8px; font-weight: 400; }
QTableCornerButton::section { background: transparent; border: none; }

QTabWidget::pane { border: none; border-top: 1px solid $line; }
QTabBar { background: transparent; }
QTabBar::tab { background: transparent; color: $muted; border: none; border-bottom: 2px solid transparent;
    padding: 6px 12px; }
QTabBar::tab:hover { color: $text; }
QTabBar::tab:selected { color: $accent; border-bottom: 2px solid $accent; font-weight: 700; }

QScrollArea { background: transparent; border: none; }
QScrollArea > QWidget { background: transparent; }
QScrollArea > QWidget > QWidget#scrolled { background: transparent; }
QScrollBar:vertical { background: transparent; width: 10px; margin: 2px; }
QScrollBar:horizontal { background: transparent; height: 10px; margin: 2px; }
QScrollBar::handle { background: $line; border-radius: 3px; min-height: 24px; min-width: 24px; }
QScrollBar::handle:hover { background: $faint; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
QSplitter::handle { background: transparent; }

QMenu { background: $card; color: $text; border: 1px solid $line; padding: 4px; }
QMenu::item { padding: 6px 24px 6px 12px; border-radius: 4px; }
QMenu::item:selected { background: $accent_soft; color: $text; }
QMenu::separator { height: 1px; background: $line; margin: 4px 8px; }
QDialog { background: $card; }
QGroupBox { border: none; margin-top: 24px; font-weight: 700; }
QGroupBox::title { subcontrol-origin: margin; left: 0; padding: 0; }
"""
