"""Closed programs for differential fuzzing: they terminate without input and use most of KRL."""
