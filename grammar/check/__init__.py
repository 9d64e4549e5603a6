"""Static checks: types, declarations, calls, control flow, places, and what stops the advance run.

A check is a function from a `analysis.context.Context` to findings, and lies in the folder of its
subject. `project.framework` lists all checks and runs them over a file or a workspace,
`project.project_check` and `project.batch` over whole backups.
"""
