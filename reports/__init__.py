"""The window: records become pages that people read. Imports none of the other packages."""

from reports.claims_page import write_claims_page
from reports.conform_page import write_conformance_page
from reports.growth_page import write_growth_page
from reports.nightly_page import write_night_page
from reports.run_page import write_run_page
from reports.survey_page import write_survey_page

__all__ = [
    "write_claims_page",
    "write_conformance_page",
    "write_growth_page",
    "write_night_page",
    "write_run_page",
    "write_survey_page",
]
