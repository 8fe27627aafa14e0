"""The run page: its Qt-free view model, the bridge to the run's thread, and the widgets that show it."""
