"""Exchange with third parties: the export of the cases, their recordings, and their parsers."""
