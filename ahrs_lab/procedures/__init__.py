"""What is done on a bench: plans, procedures as generators of commands, the runner."""
