"""The objective of DensiCrafter (Dang et al., AAAI 2026), and its solvers."""
