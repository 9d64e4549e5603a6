"""The Robotics API: commands with events, linked into transactions, without KRL."""
