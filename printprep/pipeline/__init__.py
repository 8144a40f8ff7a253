"""The way through the house: prepare, fill, advise, check; one job, from file to file."""
