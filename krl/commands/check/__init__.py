"""`krl check`: what the controller would complain about, and more, before anything is uploaded."""
