"""The density of a part: the lean program, one linear program a body, and its certificate."""
