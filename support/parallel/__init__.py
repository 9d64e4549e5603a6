"""Work in processes of this machine or on a Dask cluster, and progress while it runs."""
