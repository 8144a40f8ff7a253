"""The pipeline: prepare, fill, advise, check; and the job that runs one model from file to file."""
