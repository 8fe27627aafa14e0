"""Widgets that only these pages need; what all pages are made of is in :mod:`ahrs_lab.ui.widgets`."""
