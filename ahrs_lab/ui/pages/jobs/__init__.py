"""The page Jobs: the list, and the job's editor with the check list before its run."""
