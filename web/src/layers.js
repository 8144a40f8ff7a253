/**
 * The part in its layers: which are seen, how clear the outside is, thickness as colours.
 */
import {
  BufferAttribute,
  Color,
  DoubleSide,
  FrontSide,
  Mesh,
  MeshStandardMaterial,
} from "three";
import { LAYER_COLOURS, thicknessColour, WALL_SHARE } from "./colours.js";
import { creased } from "./creased.js";

/** Solids that are only cut, not drawn: their surfaces are the part's own. */
const ONLY_CUT = new Set(["infill"]);
const OUTER = new Set(["outside", "base"]);
const SKIN_SEEN_THROUGH = 0.22;

/**
 * @typedef {object} Solid a closed mesh
 * @property {string} name
 * @property {import("./decode.js").Mesh} mesh
 * @property {import("three").BufferGeometry} geometry
 */

export class Layers {
  /**
   * @param {import("./stage.js").Stage} stage
   * @param {import("./decode.js").Mesh[]} meshes the part first
   * @param {number} wallMm
   */
  constructor(stage, meshes, wallMm) {
    this.stage = stage;
    this.scaleTop = wallMm / WALL_SHARE;
    /** @type {Solid[]} */
    this.solids = meshes.map((mesh) => ({ name: mesh.name, mesh, geometry: creased(mesh) }));
    /** @type {Map<string, MeshStandardMaterial[]>} */
    this.materials = new Map();
    /** @type {Mesh[]} */
    this.drawn = [];
    /** @type {Set<MeshStandardMaterial>} those of the part, whose corners have a thickness */
    this.ofPart = new Set();
    this.clear = 0;
    this.thickness = false;
    const [part, ...others] = this.solids;
    this.#colourThickness(part);
    const drawnByPart = this.#drawPart(part);
    for (const solid of others) {
      if (!drawnByPart.has(solid.name) && !ONLY_CUT.has(solid.name)) {
        this.#drawSolid(solid);
      }
    }
  }

  /** Names of all layers that can be switched, in the order they are listed. */
  get names() {
    const cut = this.solids.slice(1).map((solid) => solid.name);
    return Object.keys(LAYER_COLOURS).filter(
      (name) => this.materials.has(name) || cut.includes(name),
    );
  }

  /** @param {Solid} part */
  #drawPart(part) {
    const layers = part.mesh.layers.filter((layer) => layer.count > 0);
    const materials = layers.map(({ name }) => this.#material(name, OUTER.has(name)));
    this.ofPart = new Set(materials);
    layers.forEach(({ start, count }, i) => part.geometry.addGroup(3 * start, 3 * count, i));
    this.#add(new Mesh(part.geometry, materials));
    return new Set(layers.map((layer) => layer.name));
  }

  /** @param {Solid} solid */
  #drawSolid(solid) {
    this.#add(new Mesh(solid.geometry, this.#material(solid.name, false)));
  }

  /** @param {Mesh} mesh */
  #add(mesh) {
    this.drawn.push(mesh);
    this.stage.part.add(mesh);
  }

  /**
   * @param {string} name
   * @param {boolean} outer seen from outside only
   */
  #material(name, outer) {
    const material = new MeshStandardMaterial({
      color: LAYER_COLOURS[name],
      roughness: 0.72,
      metalness: 0,
      side: outer ? FrontSide : DoubleSide,
      // Triangles without width have a depth of any size: this puts them behind the outside
      polygonOffset: !outer,
      polygonOffsetFactor: 1.5,
      polygonOffsetUnits: 2,
    });
    this.materials.set(name, [...(this.materials.get(name) ?? []), material]);
    return material;
  }

  /** @param {Solid} part */
  #colourThickness(part) {
    const { thickness, index } = part.mesh;
    if (thickness === null) {
      return;
    }
    const colours = new Float32Array(3 * index.length);
    const colour = new Color();
    for (let corner = 0; corner < index.length; corner += 1) {
      thicknessColour(thickness[index[corner]], this.scaleTop, colour).toArray(colours, 3 * corner);
    }
    part.geometry.setAttribute("color", new BufferAttribute(colours, 3));
  }

  /**
   * @param {string} name
   * @param {boolean} seen
   */
  show(name, seen) {
    for (const material of this.materials.get(name) ?? []) {
      material.visible = seen;
    }
    this.stage.draw();
  }

  /** @param {string} name */
  shown(name) {
    return this.materials.get(name)?.[0].visible ?? true;
  }

  /** @param {number} clear share, 0 for an outside that hides all */
  setClear(clear) {
    this.clear = clear;
    this.#refresh();
  }

  /** @param {boolean} on */
  setThickness(on) {
    this.thickness = on;
    this.#refresh();
  }

  #refresh() {
    for (const [name, materials] of this.materials) {
      const skin = name === "cavity" && this.clear > 0 ? SKIN_SEEN_THROUGH : 1;
      const opacity = OUTER.has(name) ? 1 - this.clear : skin;
      for (const material of materials) {
        material.opacity = opacity;
        material.transparent = opacity < 1;
        material.depthWrite = opacity === 1;
        const coloured = this.thickness && this.ofPart.has(material);
        material.vertexColors = coloured;
        material.color.set(coloured ? "#ffffff" : LAYER_COLOURS[name]);
        material.needsUpdate = true;
      }
    }
    this.stage.draw();
  }

  /** @param {import("three").Plane[]} planes */
  clip(planes) {
    for (const materials of this.materials.values()) {
      for (const material of materials) {
        material.clippingPlanes = planes;
      }
    }
  }

  dispose() {
    for (const mesh of this.drawn) {
      mesh.removeFromParent();
    }
    for (const solid of this.solids) {
      solid.geometry.dispose();
    }
    for (const material of [...this.materials.values()].flat()) {
      material.dispose();
    }
  }
}
