/**
 * One page's part on the stage: its layers, section, balance and bed, built together.
 */
import { Matrix4, Vector3 } from "three";
import { Balance } from "./balance.js";
import { Bed } from "./bed.js";
import { decode } from "./decode.js";
import { Layers } from "./layers.js";
import { Section } from "./section.js";
import { Stage } from "./stage.js";

export const LOOKS = {
  home: new Vector3(0.46, -0.8, 0.37),
  side: new Vector3(0.85, -0.42, 0.3), // on a cut along x
  front: new Vector3(0, -1, 0.02),
  right: new Vector3(1, 0, 0.02),
  top: new Vector3(0, -0.02, 1),
};

export class Viewer {
  /**
   * @param {Stage} stage
   * @param {import("./page.js").View} view
   * @param {import("./decode.js").Mesh[]} meshes
   */
  constructor(stage, view, meshes) {
    this.stage = stage;
    this.view = view;
    stage.beforeDraw = [];
    this.layers = new Layers(stage, meshes, view.wallMm);
    this.section = new Section(stage, this.layers);
    this.bed = new Bed(stage);
    this.balance = view.balance
      ? new Balance(stage, view.balance, meshes[0].positions)
      : null;
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./page.js").View} view
   * @param {string} geometry base64
   */
  static async open(canvas, view, geometry) {
    const meshes = await decode(view.directory, geometry);
    return new Viewer(new Stage(canvas, view), view, meshes);
  }

  /**
   * Takes another page's part onto the same stage.
   * @param {import("./page.js").View} view
   * @param {string} geometry base64
   */
  async follow(view, geometry) {
    const meshes = await decode(view.directory, geometry);
    this.dispose();
    this.stage.frame(view);
    return new Viewer(this.stage, view, meshes);
  }

  /**
   * Shows the part as it would stand in a pose; null puts it back.
   * @param {number[] | null} rotation (3, 3) by rows
   */
  pose(rotation) {
    const { part } = this.stage;
    this.balance?.set(0, this.balance.azimuth);
    this.balance?.show(rotation === null);
    part.position.set(0, 0, 0);
    part.quaternion.identity();
    if (rotation !== null) {
      const [a, b, c, d, e, f, g, h, i] = rotation;
      part.quaternion.setFromRotationMatrix(
        new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1),
      );
      part.position.copy(this.#onBed());
    }
    this.stage.draw();
  }

  /** The move that puts the turned part on the bed, in the middle. */
  #onBed() {
    const { part, middle } = this.stage;
    const { positions } = this.layers.solids[0].mesh;
    const place = new Vector3();
    let low = Infinity;
    for (let i = 0; i < positions.length; i += 3) {
      low = Math.min(low, place.fromArray(positions, i).applyQuaternion(part.quaternion).z);
    }
    const centre = middle.clone().applyQuaternion(part.quaternion);
    return new Vector3(middle.x - centre.x, middle.y - centre.y, -low);
  }

  dispose() {
    this.layers.dispose();
    this.section.dispose();
    this.bed.dispose();
    this.balance?.dispose();
  }
}
