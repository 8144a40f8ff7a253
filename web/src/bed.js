/**
 * The bed under the part: a grid of centimetres, as large as the part needs.
 */
import { BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry, DoubleSide, Vector3 } from "three";
import { themed } from "./colours.js";

export class Bed {
  /** @param {import("./stage.js").Stage} stage */
  constructor(stage) {
    this.group = new Group();
    const across = Math.max(stage.high.x - stage.low.x, stage.high.y - stage.low.y, 1);
    const step = [1, 2, 5, 10, 20, 50, 100, 200].find((s) => across / s < 14) ?? 500;
    const cells = Math.ceil((0.85 * across) / step);
    const half = cells * step;
    const middle = new Vector3(
      Math.round(stage.middle.x / step) * step,
      Math.round(stage.middle.y / step) * step,
      -stage.size / 2000,
    );
    const points = [];
    for (let i = -cells; i <= cells; i += 1) {
      points.push(new Vector3(i * step, -half, 0), new Vector3(i * step, half, 0));
      points.push(new Vector3(-half, i * step, 0), new Vector3(half, i * step, 0));
    }
    this.lines = new LineSegments(
      new BufferGeometry().setFromPoints(points),
      new LineBasicMaterial({ transparent: true, opacity: 0.55 }),
    );
    this.plate = new Mesh(
      new PlaneGeometry(2 * half, 2 * half),
      new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.5, depthWrite: false }),
    );
    this.plate.position.z = -stage.size / 1500;
    this.plate.renderOrder = -2;
    this.lines.renderOrder = -1;
    this.group.position.copy(middle);
    this.group.add(this.plate, this.lines);
    stage.bed.add(this.group);
    this.recolour();
  }

  recolour() {
    this.lines.material.color.copy(themed("--grid"));
    this.plate.material.color.copy(themed("--plate"));
  }

  dispose() {
    this.group.removeFromParent();
  }
}
