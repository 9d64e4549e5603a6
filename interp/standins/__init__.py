"""Stand-ins for what an incomplete backup uses and does not contain."""
