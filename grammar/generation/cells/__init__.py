"""Whole cells in the manner of real ones: folders of modules in every dialect."""
