"""The survey: every file of a corpus is read under one grammar, and failures are collected."""
