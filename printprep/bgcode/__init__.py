"""Binary G-code of PrusaSlicer (.bgcode): its blocks, their content as text, a block to append."""
