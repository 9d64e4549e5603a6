"""Whole cells that resemble real ones: folders of modules in every dialect."""
