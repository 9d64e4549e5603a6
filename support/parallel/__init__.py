"""Parallel work in local processes or on a Dask cluster, and progress reports."""
