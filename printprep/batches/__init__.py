"""Many models: one journal, one row a model, on this machine or on a Dask cluster."""
