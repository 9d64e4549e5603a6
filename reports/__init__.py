"""The window: records become pages that people read. Imports none of the other packages."""

from reports.survey_page import write_survey_page

__all__ = ["write_survey_page"]
