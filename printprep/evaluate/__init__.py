"""The paper's tables, on any folder of models, in the paper's voxel picture."""
