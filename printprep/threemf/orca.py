"""Items as OrcaSlicer and BambuStudio lay them out: each volume an object of its own.

An item is an object without a mesh whose components are its volumes.  The config
Metadata/model_settings.config names the item by the id of that object, each volume by the id of its
component's object, and says with ``subtype`` what the volume is for.

The place on the bed stands in the components, and the item of the build has no transform: some
versions apply the item's transform to the first volume alone where the file is of another program,
and a support blocker would stay behind.  Every object is of type "model", as the core specification
asks of what a build uses; both programs take the purpose from the config.

Source: OrcaSlicer's and BambuStudio's src/libslic3r/Format/bbs_3mf.cpp (_handle_start_component,
_handle_start_config_volume, _generate_volumes_new) and src/libslic3r/Model.cpp (type_from_string).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from printprep.threemf.mesh_xml import mesh_lines
from printprep.threemf.xml_text import escape

if TYPE_CHECKING:
    from printprep.threemf.item import Item, VolumeKind
    from printprep.threemf.painting import Painter

SUBTYPES: Mapping[VolumeKind, str] = {
    "ModelPart": "normal_part",
    "NegativeVolume": "negative_part",
    "ParameterModifier": "modifier_part",
    "SupportBlocker": "support_blocker",
    "SupportEnforcer": "support_enforcer",
}


def object_count(items: Sequence[Item]) -> int:
    """The number of objects that the items make, which is the highest of their ids."""
    return sum(len(item.volumes) + 1 for item in items)


def item_ids(items: Sequence[Item]) -> list[int]:
    """The id of each item's object; those of its volumes come right before it."""
    ids, last = [], 0
    for item in items:
        last += len(item.volumes) + 1
        ids.append(last)
    return ids


def object_lines(items: Sequence[Item], painter: Painter) -> Iterator[bytes]:
    """The objects of the items: a component must stand before the object that uses it."""
    for own, item in zip(item_ids(items), items, strict=True):
        first = own - len(item.volumes)
        x, y, z = (f"{float(value):.9g}" for value in item.translation_mm)
        for number, volume in enumerate(item.volumes, first):
            default = painter.default(replace(item, volumes=[volume]))
            name = escape(volume.name)
            yield f'  <object id="{number}" type="model" name="{name}"{default}>\n'.encode()
            yield from mesh_lines([volume], painter)
            yield b"  </object>\n"
        yield f'  <object id="{own}" type="model" name="{escape(item.name)}">\n'.encode()
        yield b"   <components>\n"
        move = f"1 0 0 0 1 0 0 0 1 {x} {y} {z}"
        for number in range(first, own):
            yield f'    <component objectid="{number}" transform="{move}"/>\n'.encode()
        yield b"   </components>\n  </object>\n"


def build_lines(items: Sequence[Item]) -> Iterator[bytes]:
    """The items of the build."""
    for own in item_ids(items):
        yield f'  <item objectid="{own}"/>\n'.encode()


def config(items: Sequence[Item]) -> bytes:
    """The content of Metadata/model_settings.config."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<config>"]
    for own, item in zip(item_ids(items), items, strict=True):
        lines.append(f' <object id="{own}">')
        lines += _keys("  ", item.name, item.settings)
        for number, volume in enumerate(item.volumes, own - len(item.volumes)):
            lines.append(f'  <part id="{number}" subtype="{SUBTYPES[volume.kind]}">')
            lines += _keys("   ", volume.name, volume.settings)
            lines.append("  </part>")
        lines.append(" </object>")
    lines.append("</config>\n")
    return "\n".join(lines).encode()


def _keys(indent: str, name: str, settings: Mapping[str, str]) -> Iterator[str]:
    for key, value in {"name": name, **dict(sorted(settings.items()))}.items():
        yield f'{indent}<metadata key="{key}" value="{escape(value)}"/>'
