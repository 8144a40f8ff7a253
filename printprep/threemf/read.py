"""Reads a 3MF of any program: everything that its build prints, as one mesh in mm.

It reads the meshes of objects of type "model" that a printable item of the build puts on the bed,
directly or through components, with every transform applied.  It leaves out support objects, and
volumes that a slicer keeps in the same object but does not print as material (modifiers, support
blockers and enforcers, by the configs of PrusaSlicer, BambuStudio and OrcaSlicer).  A *negative*
volume would change the shape: such a file is refused.

It accepts what real files have: missing relationships or ones to no part, part names in another
case, a missing unit, doubled or unused vertices, degenerate triangles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.threemf.archive import Archive
from printprep.threemf.package import MODEL_PART
from printprep.threemf.parse import (
    ObjectReference,
    ParsedModel,
    ParsedObject,
    parse_elements,
    parse_model,
)
from printprep.threemf.volumes import read_unprinted

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

ATTACHMENT = "Metadata/printprep.json"
_ATTACHMENT_BYTES_MAX = 16 << 20
_TRIANGLES_MAX = 30_000_000
_DEPTH_MAX = 64
_PLACED_MAX = 100_000
_SOLID = "model"
_AGAIN = "Export the model again."


@dataclass(frozen=True, eq=False)
class ThreeMF:
    """The mesh that a 3MF prints.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64, not welded across objects;
    names : of the objects on the bed, in build order;
    attachments : printprep's JSON by part name, where printprep wrote the file;
    unit_mm : length of one unit of the file, already applied to ``vertices``.
    """

    vertices: Float
    faces: Int
    names: tuple[str, ...]
    attachments: Mapping[str, bytes] = field(default_factory=dict)
    unit_mm: float = 1.0


def read_3mf(path: str | Path) -> ThreeMF:
    """Read the 3MF at `path`.  Raises InputError that names the file and the fact."""
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path} does not exist.", "Check the name and the folder.")
    with Archive(path) as archive:
        build = _Build(archive)
        build.place_all()
        if not build.faces:
            raise InputError(
                f"{archive.name} prints nothing: no item of its build has triangles.",
                "Put the model on the bed in the program that wrote the file, and export it again.",
            )
        attachments = {}
        if ATTACHMENT in archive:
            attachments[ATTACHMENT] = archive.read(ATTACHMENT, _ATTACHMENT_BYTES_MAX)
    return ThreeMF(
        np.concatenate(build.vertices),
        np.concatenate(build.faces),
        tuple(build.names),
        attachments,
        build.unit_mm,
    )


class _Build:
    """Walks the build of the root model, and gathers what it prints in mm.

    vertices, faces : a list with (n, 3) mm and (m, 3) for each mesh placed; faces count through the
    vertices of all of them.
    """

    def __init__(self, archive: Archive) -> None:
        self.vertices: list[Float] = []
        self.faces: list[Int] = []
        self.names: list[str] = []
        self.unit_mm = 1.0
        self._archive = archive
        self._root = _root_part(archive)
        self._unprinted = read_unprinted(archive)
        self._models: dict[str, ParsedModel] = {}
        self._meshes: dict[tuple[str, str], tuple[Float, Int]] = {}
        self._placed = self._vertex_count = self._face_count = 0

    def place_all(self) -> None:
        model = self._model(self._root)
        self.unit_mm = model.unit_mm
        to_mm = np.diag([model.unit_mm, model.unit_mm, model.unit_mm, 1.0])
        for item in model.items:
            part = item.part or self._root
            if self._object(part, item.object_id).kind == _SOLID:
                self.names.append(self._object(part, item.object_id).name)
                self._place(part, item, to_mm, item.object_id, 0)

    def _place(
        self, part: str, here: ObjectReference, outer: Float, top_id: str, depth: int
    ) -> None:
        """Add an object and its components; outer : (4, 4), place of what holds it, row vectors."""
        self._placed += 1
        if depth > _DEPTH_MAX or self._placed > _PLACED_MAX:
            raise InputError(
                f"{self._archive.name} has components that contain themselves, or too many of them."
            )
        found = self._object(part, here.object_id)
        if found.kind != _SOLID:
            return
        matrix = np.column_stack([here.transform, [0.0, 0.0, 0.0, 1.0]]) @ outer  # row vectors
        if found.indices:
            self._add(part, here.object_id, matrix)
        for component in found.components:
            if (top_id, component.object_id) not in self._unprinted.components:
                self._place(component.part or part, component, matrix, top_id, depth + 1)

    def _add(self, part: str, object_id: str, matrix: Float) -> None:
        """Add the mesh of an object; matrix : (4, 4), file's unit → mm, for row vectors."""
        points, faces = self._mesh(part, object_id)
        if not len(faces):
            return
        with np.errstate(over="ignore", invalid="ignore"):
            moved = points @ matrix[:3, :3] + matrix[3, :3]
        if not np.isfinite(moved).all():
            raise InputError(
                f"{self._archive.name}: object {object_id} has coordinates that are too large."
            )
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            faces = faces[:, ::-1]  # a mirror image is inside out
        self.vertices.append(moved)
        self.faces.append(faces + self._vertex_count)
        self._vertex_count += len(moved)
        self._face_count += len(faces)
        if self._face_count > _TRIANGLES_MAX:
            raise InputError(
                f"{self._archive.name} prints more than {_TRIANGLES_MAX} triangles.",
                "Reduce the number of triangles in a modelling program.",
            )

    def _mesh(self, part: str, object_id: str) -> tuple[Float, Int]:
        """The vertices (n, 3), in the file's unit, and triangles (m, 3) that an object prints."""
        key = (part, object_id)
        if key not in self._meshes:
            found = self._object(part, object_id)
            points = np.array(found.coordinates, dtype=np.float64).reshape(-1, 3)
            faces = np.array(found.indices, dtype=np.int64).reshape(-1, 3)
            where = f"{self._archive.name}: object {object_id}"
            if not np.isfinite(points).all():
                raise InputError(f"{where} has coordinates that are not finite.", _AGAIN)
            if faces.min() < 0 or faces.max() >= len(points):
                raise InputError(
                    f"{where} has triangles that use a vertex which does not exist.", _AGAIN
                )
            if part == self._root:
                printed = np.ones(len(faces), dtype=bool)
                for first, last in self._unprinted.triangles.get(object_id, ()):
                    printed[max(first, 0) : max(last + 1, 0)] = False
                faces = faces[printed]
            used = np.zeros(len(points), dtype=bool)
            used[faces] = True
            self._meshes[key] = points[used], (np.cumsum(used) - 1)[faces]
        return self._meshes[key]

    def _object(self, part: str, object_id: str) -> ParsedObject:
        objects = self._model(part).objects
        if object_id not in objects:
            raise InputError(
                f"{self._archive.name}: the build uses object {object_id}, which does not exist.",
                _AGAIN,
            )
        return objects[object_id]

    def _model(self, part: str) -> ParsedModel:
        if part not in self._models:
            with self._archive.open(part) as stream:
                self._models[part] = parse_model(stream, f"{self._archive.name}: {part}")
        return self._models[part]


def _root_part(archive: Archive) -> str:
    """The model part that the package names, else the usual one, else the first one."""
    if "_rels/.rels" in archive:
        relations = parse_elements(archive.read("_rels/.rels"), f"{archive.name}: _rels/.rels")
        for _, _, attributes in relations:
            target = attributes.get("Target", "")
            if attributes.get("Type", "").endswith("/3dmodel") and target in archive:
                return target
    if MODEL_PART in archive:
        return MODEL_PART
    models = archive.with_suffix(".model")
    if not models:
        raise InputError(
            f"{archive.name} holds no 3D model.", "Check that it is a 3MF file and export it again."
        )
    return models[0]
