/**
 * The section: a plane that opens the part, its cut closed and coloured by what it cuts.
 *
 * Every closed mesh is counted into the stencil buffer (back faces up, front faces down); where the
 * count is not zero the plane runs through it.  The part comes first, in the colour of its wall, and
 * vaults, ballast, infill, base and plugs after it, over the same depth.
 */
import {
  AlwaysStencilFunc,
  BackSide,
  DecrementWrapStencilOp,
  DoubleSide,
  FrontSide,
  Group,
  IncrementWrapStencilOp,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  Plane,
  PlaneGeometry,
  ReplaceStencilOp,
  Vector3,
} from "three";
import { LAYER_COLOURS } from "./colours.js";

/** @typedef {"off" | "x" | "y" | "z" | "view"} Axis */

/** @type {Record<"x" | "y" | "z", Vector3>} */
const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
const ORDER = ["part", "infill", "ballast", "vaults", "base", "plugs"];

export class Section {
  /**
   * @param {import("./stage.js").Stage} stage
   * @param {import("./layers.js").Layers} layers
   */
  constructor(stage, layers) {
    this.stage = stage;
    this.layers = layers;
    /** @type {Axis} */
    this.axis = "off";
    this.flipped = false;
    this.normal = new Vector3(0, 1, 0); // in the part's coordinates; what lies beyond is removed
    this.at = 0;
    /** The plane in the world: three.js removes what lies on its negative side. */
    this.plane = new Plane();
    this.group = new Group();
    this.group.visible = false;
    stage.part.add(this.group);
    /** @type {Mesh[]} */
    this.caps = [];
    /** @type {Map<string, Mesh[]>} */
    this.passes = new Map();
    /** @type {Set<string>} */
    this.hidden = new Set();
    const quad = new PlaneGeometry(3 * stage.size, 3 * stage.size);
    for (const name of ORDER) {
      const solid = layers.solids.find((found) => found.name === name);
      if (solid !== undefined) {
        this.#addCap(name, solid, quad);
      }
    }
    stage.beforeDraw.push(() => this.#place());
  }

  /**
   * @param {string} name
   * @param {import("./layers.js").Solid} solid
   * @param {PlaneGeometry} quad
   */
  #addCap(name, solid, quad) {
    const order = 1 + this.caps.length;
    const count = /** @param {import("three").Side} side */ (side) => {
      const op = side === BackSide ? IncrementWrapStencilOp : DecrementWrapStencilOp;
      const material = new MeshBasicMaterial({
        side,
        colorWrite: false,
        depthWrite: false,
        depthTest: false,
        stencilWrite: true,
        stencilFunc: AlwaysStencilFunc,
        stencilFail: op,
        stencilZFail: op,
        stencilZPass: op,
        clippingPlanes: [this.plane],
      });
      const mesh = new Mesh(solid.geometry, material);
      mesh.renderOrder = order;
      return mesh;
    };
    const cap = new Mesh(
      quad,
      new MeshBasicMaterial({
        color: LAYER_COLOURS[name === "part" ? "wall" : name],
        side: DoubleSide,
        stencilWrite: true,
        stencilRef: 0,
        stencilFunc: NotEqualStencilFunc,
        stencilFail: ReplaceStencilOp,
        stencilZFail: ReplaceStencilOp,
        stencilZPass: ReplaceStencilOp,
      }),
    );
    cap.renderOrder = order + 0.5;
    cap.onAfterRender = (renderer) => renderer.clearStencil();
    const passes = [count(BackSide), count(FrontSide), cap];
    this.passes.set(name, passes);
    this.caps.push(cap);
    this.group.add(...passes);
  }

  /**
   * How far the plane can go along its normal, mm.
   * @returns {[number, number]}
   */
  range() {
    const { low, high } = this.stage;
    let [least, most] = [Infinity, -Infinity];
    for (const x of [low.x, high.x]) {
      for (const y of [low.y, high.y]) {
        for (const z of [low.z, high.z]) {
          const along = this.normal.dot(new Vector3(x, y, z));
          least = Math.min(least, along);
          most = Math.max(most, along);
        }
      }
    }
    return [least, most];
  }

  /** @param {Axis} axis */
  setAxis(axis) {
    this.axis = axis;
    this.group.visible = axis !== "off";
    if (axis === "view") {
      this.stage.camera.getWorldDirection(this.normal).negate();
      this.normal.applyQuaternion(
        this.stage.part.getWorldQuaternion(this.stage.part.quaternion.clone()).invert(),
      );
    } else if (axis !== "off") {
      this.normal.copy(AXES[axis]);
    }
    this.layers.clip(axis === "off" ? [] : [this.plane]);
    this.stage.draw();
  }

  /** @param {number} at mm along the normal */
  moveTo(at) {
    const [least, most] = this.range();
    this.at = Math.min(Math.max(at, least), most);
    this.stage.draw();
  }

  flip() {
    this.flipped = !this.flipped;
    this.stage.draw();
  }

  /**
   * Colours the cut through a layer as the part's own wall, or in its own colour again.
   * @param {string} name
   * @param {boolean} hidden
   */
  hide(name, hidden) {
    if (hidden) {
      this.hidden.add(name);
    } else {
      this.hidden.delete(name);
    }
    this.stage.draw();
  }

  /** Shows the side of the cut that faces the eye. */
  faceEye() {
    const eye = this.stage.camera.position.clone().sub(this.stage.middle);
    this.flipped = this.axis !== "off" && eye.dot(this.normal) < 0;
  }

  /**
   * Whether a place is removed by the section.
   * @param {Vector3} world
   */
  removes(world) {
    return this.axis !== "off" && this.plane.distanceToPoint(world) < 0;
  }

  /** The middle of the cut in the world, the normal there, and a place for a handle beside it. */
  handle() {
    const { part, middle, high, size } = this.stage;
    const centre = middle
      .clone()
      .addScaledVector(this.normal, this.at - this.normal.dot(middle));
    const beside = centre.clone();
    if (Math.abs(this.normal.z) < 0.9) {
      beside.z = high.z + 0.05 * size;
    } else {
      beside.x = high.x + 0.06 * size;
    }
    const normal = this.normal.clone().transformDirection(part.matrixWorld);
    return { place: part.localToWorld(centre), normal, beside: part.localToWorld(beside) };
  }

  #place() {
    if (this.axis === "off") {
      return;
    }
    const { place, normal } = this.handle();
    const kept = normal.clone().multiplyScalar(this.flipped ? 1 : -1);
    this.plane.setFromNormalAndCoplanarPoint(kept, place);
    const local = this.stage.part.worldToLocal(place.clone());
    for (const cap of this.caps) {
      cap.position.copy(local);
      cap.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), this.normal);
      cap.updateMatrixWorld();
    }
    for (const [name, passes] of this.passes) {
      const seen = !this.hidden.has(name === "part" ? "outside" : name);
      for (const pass of passes) {
        pass.visible = seen;
      }
    }
  }

  dispose() {
    this.group.removeFromParent();
  }
}
