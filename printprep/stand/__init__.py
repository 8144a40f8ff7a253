"""How a part stands: contact, support polygon, tilt angle."""
