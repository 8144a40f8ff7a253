"""What lies behind each finding of the catalogue, and what to do about it.

It stands beside the catalogue, which stays a table of a line a finding that every run reads; this
is the longer text of docs/troubleshooting.md.  A test demands a row here for every id there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Remedy:
    """The long answer to one finding.

    id : of its kind in the catalogue.  cause : what makes it appear, as whole sentences.
    cure : what to do, as whole sentences; where nothing has to be done, that.
    Both are Markdown of one paragraph.
    """

    id: str
    cause: str
    cure: str


@dataclass(frozen=True)
class Topic:
    """Findings that belong together, under one title."""

    title: str
    remedies: tuple[Remedy, ...]


TOPICS = (
    Topic(
        "The triangles of the file",
        (
            Remedy(
                "open-surface",
                "Triangles are missing: a scan that did not see every side, or an export that "
                "dropped faces. What is inside is then a guess.",
                "Run `printprep hollow`: it closes the holes by the gentlest repair that works and "
                "names it. Where the guess is wrong, close the hole in the program that made the "
                "model.",
            ),
            Remedy(
                "orientation",
                "Some triangles have their corners in the other order than their neighbours, so "
                "they face inward. Mirroring a model without turning its triangles does this.",
                "Run `printprep hollow`, which turns them, or recalculate the normals in the "
                "program that made the model.",
            ),
            Remedy(
                "self-intersection",
                "One surface passes through itself: a sculpted fold, a bent limb, a simplified "
                "scan.",
                "Unite the surface with itself in a modelling program (remesh, voxel remesh, "
                "boolean union); `printprep hollow` may leave it as it is. If you leave it too, "
                "look at the place in the slicer's preview.",
            ),
            Remedy(
                "overlapping-shells",
                "The model is made of bodies that were pushed into each other and never united. "
                "Slicers print their union.",
                "Nothing has to be done. `printprep hollow` unites them; other programs may need a "
                "boolean union.",
            ),
            Remedy(
                "non-manifold-edges",
                "Two bodies, or two parts of one, touch along a line without thickness.",
                "Let the bodies overlap by a tenth of a millimetre, or move them apart. "
                "`printprep hollow` does either.",
            ),
            Remedy(
                "degenerate-triangles",
                "Some triangles have no area: two corners coincide, or all three lie on a line. "
                "Rounding and simplification leave them.",
                "Nothing has to be done for printing. To be rid of them, merge close vertices in "
                "the program that made the model.",
            ),
            Remedy(
                "coarse-facets",
                "A round shape was exported with few, large triangles. The print shows them.",
                "Export the model again with a finer tolerance (chord height of 0.05 mm or less). "
                "If flat sides are meant, nothing has to be done.",
            ),
            Remedy(
                "repaired",
                "The surface of the file was no solid and was repaired: closed, united or "
                "remeshed. It is a warning where the surface moved, or where something had to be "
                "guessed.",
                "Look at the repaired part, for example with `printprep view` or `--report`. Where "
                "it is not what you mean, repair the model in the program it is from.",
            ),
            Remedy(
                "watertight",
                "The solid that is checked is not closed, or encloses no volume. In a part that "
                "printprep wrote this does not happen; another program may have changed the file.",
                "Run `printprep hollow` on the model, or take the file that printprep wrote. If "
                "that file has this finding, report it with the model.",
            ),
        ),
    ),
    Topic(
        "What was read of the file",
        (
            Remedy(
                "facet-count",
                "The header of a binary STL names another number of facets than the file has. "
                "Programs that stream a file leave such a header.",
                "Nothing has to be done where the model looks whole. Else export it again.",
            ),
            Remedy(
                "cut-short",
                "The file ends before all it promises, after a broken download or a full disk, and "
                "`--partial` asked for what is there.",
                "Export or download the file again. The missing part of the surface is closed by "
                "a guess.",
            ),
            Remedy(
                "left-out",
                "A 3MF project holds more than the model: modifiers, support blockers, objects "
                "beside the plates or switched off for printing, settings for resin. They do not "
                "belong to the solid.",
                "Check that nothing you need is in the list. Put an object that is left out onto a "
                "plate, and make it printable; place supports again after hollowing.",
            ),
            Remedy(
                "read-together",
                "The 3MF has several objects, and they were read as one model of several bodies.",
                "Nothing has to be done if they belong together. Else take one with "
                "`--object NAME` or `--object N`.",
            ),
            Remedy(
                "subtracted",
                "The project has negative volumes. They were subtracted from their object, as the "
                "slicer does.",
                "Nothing has to be done. If you do not want the hole, delete the negative volume "
                "in the project.",
            ),
            Remedy(
                "colours-lost",
                "The format in or out has no place for the colours, or the part no longer has the "
                "triangles that were painted. The colours of STL, OBJ, PLY and GLB are not read.",
                "Save the model as a 3MF with its colours and write a .3mf file; "
                "[formats](formats.md) lists what is kept. Paint the rest again in the slicer.",
            ),
        ),
    ),
    Topic(
        "Size and place",
        (
            Remedy(
                "tiny-model",
                "The file is in metres or inches, or has no unit at all, and its numbers were "
                "taken for millimetres.",
                "Name the unit (`--units m`) or the size (`--size 120`, `--height`, `--scale`).",
            ),
            Remedy(
                "fits-bed",
                "The part is larger than the bed of the profile, also after a quarter turn, or "
                "taller than the printer. Far too large a part is probably in another unit.",
                "Scale it (`--size`), turn it (`--up`, `--pose`), name the unit, or name your "
                "printer's size (`printer.bed_mm` in a profile of your own).",
            ),
        ),
    ),
    Topic(
        "Walls, pins and gaps",
        (
            Remedy(
                "wall-thickness",
                "As an error, the wall around a cavity is thinner than the profile's wall: the "
                "file was hollowed elsewhere, or with a thinner wall. As a warning or information, "
                "the model itself is thin there: a fin, an ear, a blade.",
                "Hollow the solid model with the profile's wall, or name the wall you mean "
                "(`--wall`). If `printprep hollow` itself wrote the part, use a finer grid "
                "(`--resolution`). Make thin places of the model thicker, scale it up (`--size`), "
                "or handle them with care.",
            ),
            Remedy(
                "min-feature",
                "A pin, rod or tip is thinner, both ways across, than the printer holds reliably.",
                "Make it thicker, scale the model up (`--size`), or use a finer nozzle and its "
                "profile. A sharp tip that may print blunt needs nothing.",
            ),
            Remedy(
                "gap",
                "Two sides face each other closer than the printer keeps apart: a hinge, engraved "
                "letters, fingers.",
                "Widen the gap, or join its two sides. If it may print closed, nothing has to be "
                "done.",
            ),
        ),
    ),
    Topic(
        "Ceilings and overhangs",
        (
            Remedy(
                "unsupported-ceiling",
                "The ceiling of a cavity is too flat to print over air, and nothing carries it. "
                "The model was hollowed elsewhere, or with `--vaults none`.",
                "Hollow the solid model with printprep and leave `--vaults none` out.",
            ),
            Remedy(
                "support-blocker",
                "The support blocker in the 3MF and the cavities no longer match: the file was "
                "edited, or the part was exchanged.",
                "Hollow the model again and slice the new file, or slice without supports.",
            ),
            Remedy(
                "overhang-area",
                "The outside of the model overhangs by more than the printer lays without support.",
                "Nothing has to be done if supports outside are fine. Else try another axis up "
                "(`--up`) or another pose (`--pose`).",
            ),
        ),
    ),
    Topic(
        "What stays inside",
        (
            Remedy(
                "sealed-cavity",
                "A cavity has no way out. With filament it holds air, which is information; with "
                "resin or powder it holds material for ever, which is an error.",
                "With filament, nothing has to be done. With resin or powder, run "
                "`printprep hollow` on the solid model without `--no-drains`: it adds drain holes "
                "and vents.",
            ),
            Remedy(
                "drain-too-small",
                "A cavity has a way out, but its hole, or a neck on the way, is narrower than the "
                "drain hole of the profile.",
                "Widen the hole or the neck. If your resin or powder runs through narrower holes, "
                "say so (`--set drain.diameter_mm=2.5`).",
            ),
            Remedy(
                "no-vent",
                "A cavity has one hole alone, so air has to come in where resin runs out.",
                "Add a second hole at the other end of the cavity, or hollow the solid model with "
                "`--drains 2` or more.",
            ),
            Remedy(
                "trapped-volume",
                "As the part stands, a pool lies below every hole of its cavity, or in an open "
                "bowl of the model.",
                "Turn the part over before it cures, or put a hole at the lowest place. An open "
                "bowl can simply be poured out.",
            ),
            Remedy(
                "suction-cup",
                "The layers printed so far enclose an empty space, with the plate or the part as "
                "its floor: a mug, a bell, a cavity whose holes come later. The film closes it, "
                "and every peel pulls against a vacuum.",
                "Add a vent at the end of the cup toward the plate, or turn the part.",
            ),
            Remedy(
                "drain-filled",
                "Cavities that no hole of the wanted width can drain were filled, or the lowest "
                "places of their floors. Filled material is safer than trapped resin.",
                "Nothing has to be done. To save the material, try a smaller `--drain-diameter`, "
                "if resin or powder still runs through it.",
            ),
            Remedy(
                "nothing-to-hollow",
                "Nowhere is the model much thicker than two walls, or all of its inside is needed "
                "as weight so that it stands.",
                "Scale the model up (`--size`), choose a thinner `--wall`, or ask for a smaller "
                "`--lean`. `printprep explore` shows what each lean costs.",
            ),
        ),
    ),
    Topic(
        "Voids of the model",
        (
            Remedy(
                "void-filled",
                "The model has sealed voids of its own, often leftovers of modelling. They were "
                "filled, and the part got cavities of its own.",
                "Nothing has to be done. To keep the voids, use `--voids keep`.",
            ),
            Remedy(
                "void-kept",
                "A void holds a loose body, as a rattle does, or `--voids keep` asks for it.",
                "Nothing has to be done if that is meant. Else delete the loose body, or leave "
                "`--voids keep` out.",
            ),
        ),
    ),
    Topic(
        "Standing",
        (
            Remedy(
                "tilt",
                "The centre of mass lies too close to an edge of the support polygon, or beyond "
                "it.",
                "Run `printprep hollow` on the solid model: it leaves weight where it helps, and "
                "adds a base where needed. Else try `--base always`, another pose (`--pose`, "
                "`--up`), or a smaller `--lean`.",
            ),
            Remedy(
                "lean-out-of-reach",
                "No filling of this model stands at the lean: even the lowest centre of mass that "
                "the shape allows is too high for its feet. More ballast does not help.",
                "The finding names the ways that help: a larger base, another pose, another axis "
                "up, a smaller lean. `printprep explore` shows the whole curve.",
            ),
            Remedy(
                "no-contact",
                "A body does not reach down to the first layer: the model floats, or one of "
                "several bodies does.",
                "Use `--base always`, turn the part (`--up`), or join the body to the others.",
            ),
            Remedy(
                "contact-area",
                "A tall part touches the bed with little surface. It can come loose as it prints, "
                "even where it stands afterwards.",
                "Print it with a brim, or give it a base (`--base always`).",
            ),
            Remedy(
                "simulated-fall",
                "Released on a level bed, the part falls over in the physics engine.",
                "Hollow the solid model with printprep, give it a larger base "
                "(`--base always`), or another pose (`--pose`, `--up`).",
            ),
            Remedy(
                "simulated-tip",
                "On a bed that tilts, the part tips before the lean is reached.",
                "As for a part that falls: hollow the solid model, a larger base, another pose, "
                "or a smaller `--lean`.",
            ),
            Remedy(
                "simulation-disagrees",
                "The physics engine and the computed tilt angle differ by more than a degree. "
                "Feet that touch the bed at single points, or rock on it, are one cause.",
                "Rely on the smaller angle. A base (`--base always`) gives the part a sure foot. "
                "Report the model to printprep.",
            ),
        ),
    ),
    Topic(
        "The print, measured in its G-code",
        (
            Remedy(
                "printed-mass",
                "The slicer uses more or less material than computed, by other walls, layers, "
                "infill or flow than the profile's.",
                "Load the profile's settings (`printprep profiles export`), keep the object "
                "settings of the 3MF, and slice again.",
            ),
            Remedy(
                "printed-centre-of-mass",
                "The print has its weight elsewhere than the part: infill in walls that should be "
                "solid, a filled cavity, or another first layer.",
                "Load the profile's settings (`printprep profiles export`) and slice again.",
            ),
            Remedy(
                "printed-contact",
                "The first layer as printed is smaller or larger than computed. Elephant foot "
                "compensation and another height or width of the first layer do this.",
                "Switch elephant foot compensation off and use the profile's first layer, or write "
                "your own first layer into a profile and hollow again.",
            ),
            Remedy(
                "printed-tilt",
                "As printed, the part stands to a smaller angle than promised, mostly for one of "
                "the reasons above: mass, centre of mass or contact.",
                "Mend those first. Else hollow with a margin "
                "(`--set stability.lean_margin_deg=2`).",
            ),
            Remedy(
                "filled-cavity",
                "The slicer closed a cavity: its mode closes holes, or it repaired the part.",
                "Set the slicing mode to regular, and do not let the slicer repair the file.",
            ),
            Remedy(
                "support-in-cavity",
                "Supports are on and start anywhere, and the blocker in the file does not keep "
                "them out of the cavities.",
                "Set supports to start on the build plate only.",
            ),
            Remedy(
                "filament-count",
                "The slicer's own sum of filament and the moves in the G-code differ. Start G-code "
                "that prints a purge line is one cause.",
                "Treat the figures of this print as uncertain by the difference.",
            ),
            Remedy(
                "features-unknown",
                "The G-code does not say which moves are skirt, brim, support or model. Its "
                "comments were switched off, or removed by a script.",
                "Switch comments (verbose or labelled G-code) on in the slicer, and export again.",
            ),
            Remedy(
                "several-objects",
                "The G-code prints several objects, and the figures are those of all together.",
                "Export the objects one by one to judge each.",
            ),
            Remedy(
                "another-print",
                "The print has another size than the part it should be compared with: another "
                "file was sliced, or the part was turned or scaled in the slicer.",
                "Slice the part alone, neither turned nor scaled; size and pose are options of "
                "`printprep hollow`.",
            ),
        ),
    ),
    Topic(
        "What you must know about a file",
        (
            Remedy(
                "no-settings",
                "STL, OBJ and PLY files carry a shape alone. With other settings, the slicer "
                "prints another mass and another balance.",
                "Write a .3mf file, or enter the listed settings in the slicer.",
            ),
            Remedy(
                "set-by-hand",
                "`--for` names a slicer that takes only the shape from the file, or only the "
                "settings of the object and not those of the print.",
                "Enter the listed settings before you slice (docs/slicers.md).",
            ),
            Remedy(
                "no-blocker",
                "The file cannot tell its slicer to make no supports inside, and the vaults count "
                "on that.",
                "Slice without supports, or with supports on the build plate only; or hollow with "
                "`--vaults slicer`.",
            ),
            Remedy(
                "vaults-for-slicer",
                "The file cannot carry a support blocker, or the walls are too thin for one. So "
                "the vaults are as steep as the slicer asks for, and there are more of them.",
                "Nothing has to be done. For a lighter part, write a .3mf file for PrusaSlicer, "
                "OrcaSlicer or BambuStudio, or use a thicker `--wall`.",
            ),
            Remedy(
                "infill-estimated",
                "`--fill infill` found no slicer to weigh the print with, or a body does not touch "
                "the bed. So mass and tilt angle are estimates.",
                "Install PrusaSlicer, or name it with `--slicer` or the environment variable "
                "`PRINTPREP_SLICER`. Give a body that floats a base (`--base auto`).",
            ),
            Remedy(
                "no-plugs",
                "`--plugs` was given, but the part has no drain holes: nothing was hollow, or the "
                "process does not drain.",
                "Use a profile for resin or powder, or ask for holes with `--drains`.",
            ),
        ),
    ),
)

REMEDIES: Mapping[str, Remedy] = MappingProxyType(
    {remedy.id: remedy for topic in TOPICS for remedy in topic.remedies}
)
