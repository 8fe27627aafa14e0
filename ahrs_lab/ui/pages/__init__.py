"""The pages beside the run: start, jobs, results, certificate, bench, set-up, and signing in.

Each has its view model without Qt beside it. :func:`~ahrs_lab.ui.pages.all_pages.page_entries` lists
them all on one :class:`~ahrs_lab.ui.pages.desk.Desk`.
"""
