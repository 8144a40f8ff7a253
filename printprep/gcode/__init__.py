"""G-code of printers that melt filament: read, weighed, balanced."""
