"""What all pages share: templates, embedding of untrusted texts, figures, typed records."""
