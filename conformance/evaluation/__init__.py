"""The evaluation of cases: observations against expectations, and comparison of executors."""
