"""What is kept: people, customers, devices, standards, jobs, runs, results, certificates, the audit trail.

``Records(path)`` opens the database (SQLite in WAL mode, every commit on the disk) and has four desks:

- ``people``: who works here, their roles, signing in (:mod:`ahrs_lab.records.people`);
- ``registry``: the laboratory itself, customers, devices, standards (:mod:`ahrs_lab.records.registry`);
- ``jobs``: orders through their states, runs, results, signatures (:mod:`ahrs_lab.records.jobs`);
- ``audit``: who did what, hash-chained (:mod:`ahrs_lab.records.audit`).

Rows that leave the room are frozen dataclasses (:mod:`ahrs_lab.records.rows`). Whoever changes something
hands over the :class:`~ahrs_lab.records.rows.SignedIn` that ``people.sign_in`` gave; roles are checked here,
not on a screen. What was measured or signed is only ever appended: the database itself refuses anything else,
and ``audit.verify`` finds what somebody changed past it.
"""
