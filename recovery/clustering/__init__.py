"""Failures grouped by the edit that mends them, and edits tried."""
