"""Triangle meshes in mm: reads, places, repairs, measures and writes them."""
