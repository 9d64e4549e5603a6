"""Common parts of all pages: templates, embedding of untrusted texts, figures, typed records."""
