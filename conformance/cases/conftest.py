"""Makes tests of the cases here: ``pytest conformance/cases``."""

from conformance.pytest_plugin import pytest_collect_file

__all__ = ["pytest_collect_file"]
