"""The Robotics API: commands with events, linked into transactions, independent of KRL."""
