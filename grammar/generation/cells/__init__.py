"""Synthetic robot cells that resemble real ones: folders of modules in many dialects."""
