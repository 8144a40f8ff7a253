"""The paper's own figures, for the tables to show beside printprep's.

Only figures with a source.  The paper's models are its own generated ones, not those evaluated
here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

SOURCE = "Dang et al., DensiCrafter, AAAI 2026, arXiv 2511.09298"


@dataclass(frozen=True)
class Published:
    """One row: a method, its data set, and the figures as the paper gives them (None: unknown).

    method : the name here of the same method;  table : the table here;  where : in the paper.
    """

    table: Literal["methods", "ablations"]
    method: str
    title: str
    data_set: str
    where: str
    mass_ratio: str | None = None
    stable_percent: float | None = None


PUBLISHED = (
    Published(
        table="methods",
        method="paper",
        title="the paper's own, text to 3D",
        data_set="the paper's generated models",
        where="abstract: up to 43 % less mass",
        mass_ratio="≥ 0.57",
    ),
    Published(
        table="ablations",
        method="paper",
        title="the paper's own, full method",
        data_set="the paper's generated models",
        where="ablation study",
        stable_percent=87.0,
    ),
    Published(
        table="ablations",
        method="paper-no-base",
        title="the paper's own, without B",
        data_set="the paper's generated models",
        where="ablation study",
        stable_percent=75.0,
    ),
)
