"""The AHRS drivers as the registry knows them; the entry points of the project name these."""

from __future__ import annotations

from ahrs_lab.instruments.drivers.ahrs.advanced_navigation import (
    AdvancedNavigationAhrs,
    AdvancedNavigationSettings,
)
from ahrs_lab.instruments.drivers.ahrs.listening import GenericAhrs, GenericSettings, NmeaAhrs, NmeaSettings
from ahrs_lab.instruments.drivers.ahrs.microstrain import MicroStrainAhrs, MicroStrainSettings
from ahrs_lab.instruments.drivers.ahrs.vectornav import VectorNavAhrs, VectorNavSettings
from ahrs_lab.instruments.drivers.ahrs.xsens import XsensAhrs, XsensSettings
from ahrs_lab.instruments.registry import Driver
from ahrs_lab.messages import Message

VECTORNAV = Driver(
    "ahrs",
    "vectornav",
    Message("VectorNav, binary output"),
    VectorNavSettings,
    lambda settings, around: VectorNavAhrs(settings, around.link(settings.link), around.clock),
)
XSENS = Driver(
    "ahrs",
    "xsens",
    Message("Xsens MTi, MTData2"),
    XsensSettings,
    lambda settings, around: XsensAhrs(settings, around.link(settings.link), around.clock),
)
MICROSTRAIN = Driver(
    "ahrs",
    "microstrain",
    Message("MicroStrain, MIP"),
    MicroStrainSettings,
    lambda settings, around: MicroStrainAhrs(settings, around.link(settings.link), around.clock),
)
ADVANCED_NAVIGATION = Driver(
    "ahrs",
    "advanced-navigation",
    Message("Advanced Navigation, ANPP"),
    AdvancedNavigationSettings,
    lambda settings, around: AdvancedNavigationAhrs(settings, around.link(settings.link), around.clock),
    experimental=True,
)
NMEA = Driver(
    "ahrs",
    "nmea",
    Message("NMEA heading and attitude"),
    NmeaSettings,
    lambda settings, around: NmeaAhrs(settings, around.link(settings.link), around.clock),
    experimental=True,
)
GENERIC = Driver(
    "ahrs",
    "generic",
    Message("Private text or binary format, described in TOML"),
    GenericSettings,
    lambda settings, around: GenericAhrs(settings, around.link(settings.link), around.clock),
)
