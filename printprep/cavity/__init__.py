"""From a density to a cavity: field to surface, base, subtraction."""
