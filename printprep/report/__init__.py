"""What printprep says of a part: JSON, terminal, page, thumbnail."""
