"""Pages about robot programs: a run, a comparison of two versions, the coverage of tests."""
