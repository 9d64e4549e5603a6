"""A run of cases as data for others: the record of `krl conform --json`, and JUnit XML."""
