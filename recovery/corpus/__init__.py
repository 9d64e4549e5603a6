"""The public part of the corpus: which repositories, and how their files get here."""
