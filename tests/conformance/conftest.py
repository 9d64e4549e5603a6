"""What the tests of conformance share."""

import pytest

from conformance.suite.case import Case, find_cases


@pytest.fixture(scope="session")
def own_cases() -> list[Case]:
    """All cases of this project, read once."""
    return find_cases()
