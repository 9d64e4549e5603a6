"""The evaluation of cases: run, observed, and compared with expectations and other executors."""
