"""The paper's evaluation, on any set of models, on the paper's voxels."""
