"""Reads G-code of filament printers: the mass, balance and contact of what it prints."""
