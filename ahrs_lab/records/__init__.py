"""What is kept: people, customers, devices, standards, jobs, runs, the audit trail."""
