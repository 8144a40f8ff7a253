"""Results as text for a terminal, as JSON and as charts: layout only, no geometry."""
