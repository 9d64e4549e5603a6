"""The public part of the corpus: its repositories, and how their files are fetched."""
