"""The textbook's and the patent's systems applied to recordings.

One module an analysis: a function takes records (:mod:`ahrs_lab.analysis.inertial_record`) and settings and
returns a frozen result, which gives itself as JSON (``to_json``, the keys people script against) and as a
:class:`~ahrs_lab.analysis.report.Report` that a terminal, a screen and a PDF show alike.
"""
