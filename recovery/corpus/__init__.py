"""The public part of the corpus: the list of repositories, and fetching their files."""
