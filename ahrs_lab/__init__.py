"""Calibration of attitude and heading reference systems to JJF 1536-2015, from bench to certificate."""

__version__ = "0.1.0"
