"""Negatives: programs that must stay rejected, written by hand or generated."""
