"""A second process that outlives the application: when the application's heart stops, it stops the table,
then switches the supply off. No emergency stop: what it can and cannot do is in ``docs/safety.md``."""
