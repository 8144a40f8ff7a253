"""Which items of a 3MF's build are read: those of one plate, or one object by name or number."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from printprep.errors import InputError, UsageError
from printprep.types import ReadNote
from printprep.wording import counted, shortened

if TYPE_CHECKING:
    from printprep.threemf.parse import ObjectReference
    from printprep.threemf.project import Plate, Project

# So many names are listed in a message.
_LISTED = 8


class Chooser:
    """Chooses among the items of a build.

    what : the file, for messages;  name_of : the name of an item's object;  is_solid : whether that
    object prints.  notes : what was left out, or read together.
    """

    def __init__(
        self,
        what: str,
        project: Project,
        *,
        name_of: Callable[[ObjectReference], str],
        is_solid: Callable[[ObjectReference], bool],
    ) -> None:
        self.notes: list[ReadNote] = []
        self._what = what
        self._project = project
        self._name_of = name_of
        self._is_solid = is_solid

    def chosen(
        self, items: Sequence[ObjectReference], plate: int | None, item: str | None
    ) -> list[ObjectReference]:
        """The items of the build to read: printable solids, of one plate, and one by its name.

        Raises
        ------
        InputError : there are several plates and none is named.
        UsageError : a plate or an object that the file does not have.
        """
        count: dict[str, int] = {}
        numbered: list[tuple[ObjectReference, tuple[str, int]]] = []
        for reference in items:
            number = count.get(reference.object_id, 0)
            count[reference.object_id] = number + 1
            numbered.append((reference, (reference.object_id, number)))
        off = sum(not reference.printable for reference, _ in numbered)
        if off:
            self._leave(f"{counted(off, 'object')} that {_is(off)} not printable")
        printed = [
            (reference, key)
            for reference, key in numbered
            if reference.printable and self._is_solid(reference)
        ]
        keys = {key for _, key in printed}
        plates = [found for found in self._project.plates if found.members & keys]
        members = self._members(plates, plate, item)
        if members is not None:
            everywhere = frozenset().union(*(found.members for found in plates))
            beside = len(keys - everywhere)
            if beside:
                self._leave(f"{counted(beside, 'object')} beside the plates")
            printed = [(reference, key) for reference, key in printed if key in members]
        references = [reference for reference, _ in printed]
        if item is not None:
            return [self._named(references, item)]
        if len({reference.object_id for reference in references}) > 1:
            message = (
                f"The file holds {len(references)} objects, which were read as one model: "
                f"{self._listed(references)}."
            )
            self.notes.append(
                ReadNote("read-together", message, "Take one of them with --object NAME or N.")
            )
        return references

    def _members(
        self, plates: Sequence[Plate], number: int | None, item: str | None
    ) -> frozenset[tuple[str, int]] | None:
        """The items of the plate to read, None for all."""
        listed = ", ".join(
            f"{plate.number}{f' {shortened(plate.name)!r}' if plate.name else ''} "
            f"({self._listed_ids(plate)})"
            for plate in plates[:_LISTED]
        )
        if number is not None:
            for plate in plates:
                if plate.number == number:
                    return plate.members
            raise UsageError(
                f"{self._what} has no plate {number}.",
                f"Its plates are {listed}." if plates else "It has no plates: leave out --plate.",
            )
        if len(plates) > 1 and item is None:
            raise InputError(
                f"{self._what} has {len(plates)} plates: {listed}.",
                "Name one with --plate N.",
            )
        return plates[0].members if len(plates) == 1 else None

    def _named(self, references: Sequence[ObjectReference], item: str) -> ObjectReference:
        """The one object with a name or a number.  Copies of one object count as one name."""
        names = [self._name_of(reference) for reference in references]
        wanted = item.strip()
        matches = [r for r, name in zip(references, names, strict=True) if name == item]
        if not matches:
            matches = [
                reference
                for reference, name in zip(references, names, strict=True)
                if name.strip().casefold() == wanted.casefold() and wanted
            ]
        if not matches and wanted.isascii() and wanted.isdecimal() and len(wanted) < 9:
            matches = list(references[int(wanted) - 1 : int(wanted)] if int(wanted) else ())
        if len({(found.part, found.object_id) for found in matches}) == 1:
            return matches[0]
        fact = f"{len(matches)} objects named" if matches else "no object"
        raise UsageError(
            f"{self._what} has {fact} {shortened(item)!r}.",
            f"Its objects are {self._listed(references)}." if references else None,
        )

    def _listed(self, references: Sequence[ObjectReference]) -> str:
        """Objects with their numbers: "1 'cone', 2 'block'"."""
        shown = [
            f"{number} {shortened(self._name_of(reference))!r}"
            for number, reference in enumerate(references[:_LISTED], 1)
        ]
        more = len(references) - len(shown)
        return ", ".join(shown) + (f" and {more} more" if more else "")

    def _listed_ids(self, plate: Plate) -> str:
        ids = list(dict.fromkeys(object_id for object_id, _ in sorted(plate.members)))
        names = [shortened(self._project.names.get(object_id, "")) for object_id in ids[:_LISTED]]
        more = f" and {len(ids) - _LISTED} more" if len(ids) > _LISTED else ""
        return ", ".join(name or "unnamed" for name in names) + more

    def _leave(self, what: str) -> None:
        self.notes.append(ReadNote("left-out", f"Left out of the file: {what}."))


def _is(number: int) -> str:
    return "is" if number == 1 else "are"
