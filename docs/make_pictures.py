"""Draw the README's pictures again: a sample as it came, and its part cut open.

python docs/make_pictures.py
"""

from __future__ import annotations

from pathlib import Path

import printprep
from printprep.mesh.measure import arrays
from printprep.render.thumbnail import thumbnail_png

HERE = Path(__file__).resolve().parent
SIZE = 400


def main() -> None:
    result = printprep.hollow(HERE.parent / "samples" / "spot.stl")
    pictures = HERE / "pictures"
    pictures.mkdir(exist_ok=True)
    # The thumbnail's eye looks from the front right; the cut face is turned toward it.
    turned = (0.0, 0.0, -40.0)
    whole = result.solid.manifold.rotate(turned)
    opened = result.part.manifold.trim_by_plane((-1.0, 0.0, 0.0), 0.0).rotate(turned)
    for name, manifold in (("spot.png", whole), ("spot-open.png", opened)):
        (pictures / name).write_bytes(thumbnail_png(*arrays(manifold), size=SIZE))


if __name__ == "__main__":
    main()
