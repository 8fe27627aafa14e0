"""The pages beside the run: start, jobs, results, certificate, bench, set-up, and signing in.

Each has its view model without Qt beside it. :func:`make_pages` makes them all on one
:class:`~ahrs_lab.ui.pages.desk.Desk`.
"""
