"""Reads a 3MF of any program: what its build prints, as one mesh in mm.

It reads the meshes of objects of type "model" that a printable item of the build puts on the bed,
directly or through components, with every transform applied.  Of a slicer's project it takes one
plate, tells negative volumes apart, and leaves out modifiers, support blockers and enforcers; it
says what it leaves out.  Colours and paint of the triangles are read too.

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
from printprep.threemf.choose import Chooser
from printprep.threemf.package import MODEL_PART
from printprep.threemf.parse import (
    ObjectReference,
    ParsedModel,
    ParsedObject,
    parse_elements,
    parse_model,
)
from printprep.threemf.project import VolumeRole, counts_of, read_project
from printprep.threemf.styles import StyleBook
from printprep.types import Paint, ReadNote
from printprep.wording import counted, printable, shortened

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

ATTACHMENT = "Metadata/printprep.json"
_ATTACHMENT_BYTES_MAX = 16 << 20
_TRIANGLES_MAX = 5_000_000
# Copies may give this many triangles, or this many times those that the file holds.
_COPIED_MAX = 2_000_000
_COPIES_MAX = 4
_DEPTH_MAX = 64
_PLACED_MAX = 100_000
_SOLID = "model"
_AGAIN = "Export the model again."


@dataclass(frozen=True, eq=False)
class VolumeMesh:
    """A volume of one object that is not material: a negative volume or a support blocker.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64;  span : number in ``ThreeMF.spans`` of the
    object.
    """

    name: str
    vertices: Float
    faces: Int
    span: int


@dataclass(frozen=True, eq=False)
class ThreeMF:
    """The mesh that a 3MF prints.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64, not welded across objects;
    names : of the objects on the bed, in build order;
    attachments : printprep's JSON by part name, where printprep wrote the file;
    unit_mm : length of one unit of the file, already applied to ``vertices``;
    spans : for each object on the bed, its first face and the one after its last;
    negatives : not yet subtracted;  blockers : where the slicer makes no supports;
    notes : what the user must know;
    paint : colours of the faces, None where there are none.
    """

    vertices: Float
    faces: Int
    names: tuple[str, ...]
    attachments: Mapping[str, bytes] = field(default_factory=dict)
    unit_mm: float = 1.0
    spans: tuple[tuple[int, int], ...] = ()
    negatives: tuple[VolumeMesh, ...] = ()
    blockers: tuple[VolumeMesh, ...] = ()
    notes: tuple[ReadNote, ...] = ()
    paint: Paint | None = None


def read_3mf(
    path: str | Path,
    *,
    unit_mm: float | None = None,
    plate: int | None = None,
    item: str | None = None,
) -> ThreeMF:
    """Read the 3MF at `path`.

    unit_mm : length of one unit; None takes the file's.
    plate : number of the plate to read;  item : name or number of the one object to read.

    Raises
    ------
    InputError : it cannot be read, its unit is unknown, or it has several plates and none is named;
        the message names the file and the fact.
    UsageError : a plate or an object that it does not have.
    """
    path = Path(path)
    with Archive(path) as archive:
        build = _Build(archive, unit_mm)
        build.place_all(plate, item)
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
        tuple(build.spans),
        tuple(build.negatives),
        tuple(build.blockers),
        build.notes(ours=bool(attachments)),
        build.book.paint(build.labels),
    )


@dataclass(frozen=True, eq=False)
class _Mesh:
    """What an object's own mesh is, in the file's unit.

    vertices : (n, 3);  faces : (m, 3);  labels : (m,);  apart : negative volumes and support
    blockers, each with its role, vertices and faces.
    """

    vertices: Float
    faces: Int
    labels: Int
    apart: tuple[tuple[VolumeRole, Float, Int], ...]
    left_out: tuple[VolumeRole, ...]


class _Build:
    """Walks the build of the root model, and gathers what it prints in mm.

    vertices, faces, labels : a list with (n, 3) mm, (m, 3) and (m,) for each mesh placed; faces
    count through the vertices of all of them.
    """

    def __init__(self, archive: Archive, unit_mm: float | None) -> None:
        self.vertices: list[Float] = []
        self.faces: list[Int] = []
        self.labels: list[Int] = []
        self.names: list[str] = []
        self.spans: list[tuple[int, int]] = []
        self.negatives: list[VolumeMesh] = []
        self.blockers: list[VolumeMesh] = []
        self.book = StyleBook()
        self.unit_mm = 1.0
        self._given_mm = unit_mm
        self._archive = archive
        self._root = _root_part(archive)
        self._project = read_project(archive)
        self._models: dict[str, ParsedModel] = {}
        self._meshes: dict[tuple[str, str], _Mesh] = {}
        self._placed = self._vertex_count = self._face_count = self._held = self._loaded = 0
        self._left_out: list[VolumeRole] = []
        self._notes: list[ReadNote] = []

    def place_all(self, plate: int | None, item: str | None) -> None:
        model = self._model(self._root)
        self.unit_mm = self._unit(model)
        to_mm = np.diag([self.unit_mm, self.unit_mm, self.unit_mm, 1.0])
        chooser = Chooser(
            self._archive.name, self._project, name_of=self._name, is_solid=self._is_solid
        )
        chosen_items = chooser.chosen(model.items, plate, item)
        self._notes += chooser.notes
        for chosen in chosen_items:
            part = chosen.part or self._root
            self.names.append(self._name(chosen))
            first = self._face_count
            self._place(part, chosen, to_mm, chosen.object_id, 0, apart=None)
            self.spans.append((first, self._face_count))

    def notes(self, *, ours: bool) -> tuple[ReadNote, ...]:
        """What was left out or is subtracted.

        ours : printprep wrote the file; its support blockers and modifiers are no surprise.
        """
        notes = list(self._notes)
        if self._left_out and not ours:
            message = (
                f"The project's volumes without material were left out: "
                f"{counts_of(self._left_out)}."
            )
            notes.append(ReadNote("left-out", message))
        if self._project.ignored:
            notes.append(
                ReadNote(
                    "left-out",
                    f"The project's settings for resin are not used: "
                    f"{', '.join(self._project.ignored)}.",
                    "The part gets cavities and drain holes of its own; place supports again.",
                )
            )
        if self.negatives:
            names = ", ".join(dict.fromkeys(repr(shortened(n.name)) for n in self.negatives))
            message = (
                f"{counted(len(self.negatives), 'negative volume')} of the project "
                f"({shortened(names, 200)}) {'is' if len(self.negatives) == 1 else 'are'} "
                "subtracted."
            )
            notes.append(ReadNote("subtracted", message))
        if self._project.extruders > 1:
            notes.append(
                ReadNote(
                    "colours-lost",
                    f"The project prints its volumes with {self._project.extruders} extruders; the "
                    "part is one volume and keeps none of them.",
                    "Assign the extruders again, or paint the surface in the slicer.",
                )
            )
        notes += self.book.notes()
        return tuple(notes)

    def _unit(self, model: ParsedModel) -> float:
        if self._given_mm is not None:
            return self._given_mm
        if model.unit_mm is None:
            raise InputError(
                f"{self._archive.name}: the unit {shortened(model.unit)!r} is none of micron, "
                "millimeter, centimeter, inch, foot, meter.",
                "Say the unit with --units mm, cm, m or in.",
            )
        return model.unit_mm

    def _is_solid(self, reference: ObjectReference) -> bool:
        return self._object(reference.part or self._root, reference.object_id).kind == _SOLID

    def _name(self, reference: ObjectReference) -> str:
        own = self._object(reference.part or self._root, reference.object_id).name
        return own or self._project.names.get(reference.object_id, "")

    def _place(
        self,
        part: str,
        here: ObjectReference,
        outer: Float,
        top_id: str,
        depth: int,
        *,
        apart: VolumeRole | None,
    ) -> None:
        """Add an object and its components; outer : (4, 4), place of what holds it, row vectors.

        apart : the role of a mesh that is not material.
        """
        self._placed += 1
        if depth > _DEPTH_MAX or self._placed > _PLACED_MAX:
            raise InputError(
                f"{self._archive.name} has components that contain themselves, or too many.",
                "Export the model again.",
            )
        found = self._object(part, here.object_id)
        # BambuStudio and older versions of OrcaSlicer save what is not material as type "other".
        if found.kind != _SOLID and apart is None:
            return
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = np.column_stack([here.transform, [0.0, 0.0, 0.0, 1.0]]) @ outer  # row vectors
        if found.indices:
            self._add(part, here.object_id, matrix, apart)
        for component in found.components:
            role = self._project.components.get((top_id, component.object_id))
            inner = apart
            if role is not None and role.purpose not in ("part", "negative"):
                self._left_out.append(role)
                if role.purpose != "blocker":
                    continue
            if role is not None and role.purpose != "part":
                inner = role
            self._place(component.part or part, component, matrix, top_id, depth + 1, apart=inner)

    def _add(self, part: str, object_id: str, matrix: Float, apart: VolumeRole | None) -> None:
        """Add the mesh of an object; matrix : (4, 4), file's unit → mm, for row vectors.

        apart : the role of a mesh that is not material.
        """
        mesh = self._mesh(part, object_id)
        self._left_out += mesh.left_out
        with np.errstate(over="ignore", invalid="ignore"):
            mirrored = bool(np.linalg.det(matrix[:3, :3]) < 0.0)
        span = len(self.spans)
        others = [*mesh.apart]
        if apart is not None:
            others.append((apart, mesh.vertices, mesh.faces))
        for role, vertices, faces in others:
            self._count(len(faces))
            moved = self._moved(object_id, vertices, matrix)
            turned = faces[:, ::-1] if mirrored else faces
            kept = self.blockers if role.purpose == "blocker" else self.negatives
            kept.append(VolumeMesh(printable(role.name), moved, turned, span))
        if apart is not None or not len(mesh.faces):
            return
        self._count(len(mesh.faces))
        moved = self._moved(object_id, mesh.vertices, matrix)
        faces = mesh.faces[:, ::-1] if mirrored else mesh.faces  # a mirror image is inside out
        self.vertices.append(moved)
        self.faces.append(faces + self._vertex_count)
        self.labels.append(self.book.whole(mesh.labels) if mirrored else mesh.labels)
        self._vertex_count += len(moved)
        self._face_count += len(faces)

    def _moved(self, object_id: str, points: Float, matrix: Float) -> Float:
        with np.errstate(over="ignore", invalid="ignore"):
            moved: Float = points @ matrix[:3, :3] + matrix[3, :3]
        if not np.isfinite(moved).all():
            raise InputError(
                f"{self._archive.name}: object {shortened(object_id)} has coordinates that are too "
                "large."
            )
        return moved

    def _count(self, faces: int) -> None:
        """Refuse more triangles than are read, before any memory is taken for them."""
        self._loaded += faces
        if self._loaded > _TRIANGLES_MAX:
            raise InputError(
                f"{self._archive.name} prints more than {_TRIANGLES_MAX} triangles.",
                "Reduce the number of triangles in a modelling program.",
            )
        if self._loaded > max(_COPIED_MAX, _COPIES_MAX * self._held):
            raise InputError(
                f"{self._archive.name} places copies with more than {_COPIED_MAX} triangles, while "
                f"the file holds {self._held}.",
                "Take one object with --object NAME or N.",
            )

    def _mesh(self, part: str, object_id: str) -> _Mesh:
        """The mesh of an object that prints, read once; its volumes by the root's config."""
        key = (part, object_id)
        if key not in self._meshes:
            found = self._object(part, object_id)
            points = _single(np.array(found.coordinates, dtype=np.float64).reshape(-1, 3))
            faces = np.array(found.indices, dtype=np.int64).reshape(-1, 3)
            where = f"{self._archive.name}: object {shortened(object_id)}"
            if not np.isfinite(points).all():
                raise InputError(f"{where} has coordinates that are not finite.", _AGAIN)
            if faces.min() < 0 or faces.max() >= len(points):
                raise InputError(
                    f"{where} has triangles that use a vertex which does not exist.", _AGAIN
                )
            labels = self.book.labels(self._model(part), found, len(faces))
            self._held += len(faces)
            self._meshes[key] = self._volumes(part, object_id, points, faces, labels)
        return self._meshes[key]

    def _volumes(self, part: str, object_id: str, points: Float, faces: Int, labels: Int) -> _Mesh:
        """The mesh of an object without the volumes that are not material."""
        spans = self._project.spans.get(object_id, ()) if part == self._root else ()
        printed = np.ones(len(faces), dtype=bool)
        apart: list[tuple[VolumeRole, Float, Int]] = []
        left_out: list[VolumeRole] = []
        covered = 0
        for span in spans:
            if span.role.purpose == "part":
                continue
            first, end = min(span.first, len(faces)), min(span.last + 1, len(faces))
            covered += max(end - first, 0)
            if covered > 2 * len(faces):
                raise InputError(
                    f"{self._archive.name}: the volumes of object {shortened(object_id)} overlap.",
                    _AGAIN,
                )
            printed[first:end] = False
            if span.role.purpose != "negative":
                left_out.append(span.role)
            if span.role.purpose in ("negative", "blocker") and end > first:
                apart.append((span.role, *_compact(points, faces[first:end])))
        vertices, kept = _compact(points, faces[printed])
        return _Mesh(vertices, kept, labels[printed], tuple(apart), tuple(left_out))

    def _object(self, part: str, object_id: str) -> ParsedObject:
        objects = self._model(part).objects
        if object_id not in objects:
            raise InputError(
                f"{self._archive.name}: the build uses object {shortened(object_id)}, which does "
                "not exist.",
                _AGAIN,
            )
        return objects[object_id]

    def _model(self, part: str) -> ParsedModel:
        if part not in self._models:
            with self._archive.open(part) as stream:
                label = f"{self._archive.name}: {printable(part)}"
                self._models[part] = parse_model(stream, label)
        return self._models[part]


def _compact(points: Float, faces: Int) -> tuple[Float, Int]:
    """The vertices (n, 3) that faces (m, 3) use, and the faces that count through them."""
    used, index = np.unique(faces, return_inverse=True)
    return points[used], index.reshape(-1, 3)


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


def _single(points: Float) -> Float:
    """(n, 3) points in single precision, where it holds them: as lib3mf and slicers read them.

    The text of a coordinate stands for the number nearest to it, and is seldom that number itself.
    """
    with np.errstate(over="ignore"):
        single = points.astype(np.float32).astype(np.float64)
    result: Float = np.where(np.isfinite(single) & ((single != 0) | (points == 0)), single, points)
    return result
