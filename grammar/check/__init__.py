"""Static checks: types, declarations, calls, control flow, places, and what stops the advance run.

A check is a function from a `context.Context` to findings. `framework` lists all checks and runs
them over a file or a workspace, `project_check` and `batch` over whole backups.
"""
