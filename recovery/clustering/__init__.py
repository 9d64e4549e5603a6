"""Clustering: failures grouped by the grammar edit that repairs them, and the trial of edits."""
