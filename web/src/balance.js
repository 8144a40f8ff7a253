/**
 * How it stands: support polygon, centre of mass, plumb line, weakest edge; and the bed that leans.
 *
 * Over an edge with outward normal n and offset d, a part with centre of mass c tips toward the
 * direction u when tan(lean) = (d − n·c) / (c_z n·u), as in printprep/stand/stability.py.
 */
import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineDashedMaterial,
  LineLoop,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  DoubleSide,
  Quaternion,
  ShapeGeometry,
  Shape,
  SphereGeometry,
  Vector2,
  Vector3,
} from "three";
import { themed } from "./colours.js";

const FALL_MS = 900;

/**
 * @typedef {object} Edge
 * @property {Vector2} from
 * @property {Vector2} to
 * @property {Vector2} normal
 * @property {number} offset
 */

export class Balance {
  /**
   * @param {import("./stage.js").Stage} stage
   * @param {import("./page.js").Balance} data
   * @param {Float32Array} positions of the part's corners, mm
   */
  constructor(stage, data, positions) {
    this.stage = stage;
    this.data = data;
    this.positions = positions;
    this.edges = edgesOf(data.polygon);
    this.centre = new Vector3(...data.centre);
    this.lean = 0;
    this.azimuth = data.weakestAzimuthDeg ?? 0;
    this.fallen = false;
    this.#animation = 0;
    this.figure = new Group(); // on the bed
    this.plumbs = new Group(); // in the world: plumb lines hang straight down
    stage.bed.add(this.figure);
    stage.scene.add(this.plumbs);
    const { size } = stage;
    this.after = this.#mass("--after", size / 75);
    this.before = data.centreBefore ? this.#mass("--before", size / 95) : null;
    this.#drawFigure();
    stage.beforeDraw.push(() => this.#hang());
  }

  #animation;

  #drawFigure() {
    const { size } = this.stage;
    const lift = size / 900;
    const points = this.data.polygon.map(([x, y]) => new Vector3(x, y, lift));
    if (points.length > 2) {
      const shape = new Shape(points.map((p) => new Vector2(p.x, p.y)));
      const area = new Mesh(
        new ShapeGeometry(shape),
        new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.3, depthWrite: false }),
      );
      area.position.z = lift;
      area.name = "--support";
      const outline = new LineLoop(new BufferGeometry().setFromPoints(points), new LineBasicMaterial());
      outline.name = "--support";
      this.figure.add(area, outline);
      this.#weakest(points, size);
    }
    this.recolour();
  }

  /**
   * The edge that it tips over, as a bar.
   * @param {Vector3[]} points
   * @param {number} size
   */
  #weakest(points, size) {
    const edge = this.data.weakestEdge;
    if (edge === null) {
      return;
    }
    const [a, b] = [points[edge], points[(edge + 1) % points.length]];
    const normal = this.edges[edge].normal;
    const wide = size / 140;
    const corners = [a, b, b, a].map((p, i) =>
      i < 2 ? p.clone() : p.clone().add(new Vector3(wide * normal.x, wide * normal.y, 0)),
    );
    const bar = new BufferGeometry().setFromPoints(corners.map((p) => p.setZ(size / 700)));
    bar.setIndex([0, 1, 2, 0, 2, 3]);
    const mesh = new Mesh(bar, new MeshBasicMaterial({ side: DoubleSide }));
    mesh.name = "--weakest";
    this.figure.add(mesh);
  }

  /**
   * @param {string} name of a colour
   * @param {number} radius
   */
  #mass(name, radius) {
    const ball = new Mesh(
      new SphereGeometry(radius, 24, 16),
      new MeshBasicMaterial({ depthTest: false, transparent: true }),
    );
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(6, 3));
    const line = new LineSegments(
      geometry,
      new LineDashedMaterial({
        depthTest: false,
        transparent: true,
        dashSize: this.stage.size / 60,
        gapSize: this.stage.size / 120,
      }),
    );
    const foot = new Mesh(
      new SphereGeometry(radius * 0.6, 16, 12),
      new MeshBasicMaterial({ depthTest: false, transparent: true }),
    );
    for (const item of [ball, line, foot]) {
      item.name = name;
      item.renderOrder = 50;
      item.frustumCulled = false;
    }
    this.plumbs.add(ball, line, foot);
    return { ball, line, foot };
  }

  recolour() {
    for (const item of [...this.figure.children, ...this.plumbs.children]) {
      const { material } = /** @type {Mesh<BufferGeometry, MeshBasicMaterial>} */ (item);
      material.color.copy(themed(item.name));
    }
  }

  /** Where the centres of mass are now, and where their plumb lines meet the bed. */
  #hang() {
    this.#hangOne(this.after, this.centre);
    if (this.before !== null && this.data.centreBefore !== null) {
      this.#hangOne(this.before, new Vector3(...this.data.centreBefore));
    }
  }

  /**
   * @param {{ball: import("three").Object3D, line: LineSegments, foot: import("three").Object3D}} mass
   * @param {Vector3} centre on the part
   */
  #hangOne(mass, centre) {
    const { part, bed } = this.stage;
    const from = part.localToWorld(centre.clone());
    const up = new Vector3(0, 0, 1).applyQuaternion(bed.quaternion);
    const height = from.clone().sub(bed.position).dot(up);
    const to = from.clone().addScaledVector(new Vector3(0, 0, -1), height / up.z);
    mass.ball.position.copy(from);
    mass.foot.position.copy(to);
    mass.line.geometry.setFromPoints([from, to]);
    mass.line.computeLineDistances();
  }

  /**
   * The lean at which it tips toward an azimuth, and over which edge.
   * @param {number} azimuth degrees
   */
  tipsAt(azimuth) {
    const toward = new Vector2(
      Math.cos((azimuth * Math.PI) / 180),
      Math.sin((azimuth * Math.PI) / 180),
    );
    let least = Math.PI / 2;
    let over = 0;
    this.edges.forEach((edge, i) => {
      const ahead = edge.offset - (edge.normal.x * this.centre.x + edge.normal.y * this.centre.y);
      const share = ahead <= 0 ? 1 : edge.normal.dot(toward); // behind an edge it tips anyway
      const lean = share > 1e-9 ? Math.atan(ahead / (this.centre.z * share)) : Math.PI / 2;
      if (lean < least) {
        least = lean;
        over = i;
      }
    });
    return { deg: (least * 180) / Math.PI, edge: over };
  }

  /**
   * Leans the bed; beyond the tilt angle the part falls.
   * @param {number} lean degrees
   * @param {number} azimuth degrees
   * @returns {boolean} whether it still stands
   */
  set(lean, azimuth) {
    this.lean = lean;
    this.azimuth = azimuth;
    const radians = (lean * Math.PI) / 180;
    const turn = (azimuth * Math.PI) / 180;
    const axis = new Vector3(-Math.sin(turn), Math.cos(turn), 0);
    this.stage.bed.quaternion.setFromAxisAngle(axis, radians);
    const tips = this.tipsAt(azimuth);
    const stands = lean <= tips.deg + 1e-9;
    const falls = !stands && lean > 0; // what falls by itself is shown upright on the level bed
    if (falls !== this.fallen) {
      this.fallen = falls;
      this.#fall(falls ? this.edges[tips.edge] : null);
    }
    this.stage.draw();
    return stands;
  }

  /**
   * Turns the part over an edge until it lies on the bed; null stands it up again.
   * @param {Edge | null} edge
   */
  #fall(edge) {
    cancelAnimationFrame(this.#animation);
    const { part } = this.stage;
    if (edge === null) {
      part.position.set(0, 0, 0);
      part.quaternion.identity();
      return;
    }
    const most = this.#lies(edge);
    this.#watch(edge, most);
    const axis = new Vector3(-edge.normal.y, edge.normal.x, 0);
    const pivot = new Vector3(edge.from.x, edge.from.y, 0);
    const start = performance.now();
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    /** @param {number} now */
    const step = (now) => {
      const share = still ? 1 : Math.min((now - start) / FALL_MS, 1);
      const angle = most * share * share; // it falls faster and faster
      part.quaternion.copy(new Quaternion().setFromAxisAngle(axis, angle));
      part.position.copy(pivot).sub(pivot.clone().applyQuaternion(part.quaternion));
      this.stage.draw();
      if (share < 1) {
        this.#animation = requestAnimationFrame(step);
      }
    };
    step(start);
  }

  /**
   * Looks at where the part will lie.
   * @param {Edge} edge
   * @param {number} angle radians
   */
  #watch(edge, angle) {
    const { stage } = this;
    const axis = new Vector3(-edge.normal.y, edge.normal.x, 0);
    const pivot = new Vector3(edge.from.x, edge.from.y, 0);
    const lies = stage.middle.clone().sub(pivot).applyAxisAngle(axis, angle).add(pivot);
    const target = stage.bed.localToWorld(lies.lerp(stage.middle, 0.45));
    const from = stage.camera.position.clone().sub(stage.controls.target).normalize();
    stage.fly(target.clone().addScaledVector(from, 1.45 * stage.fitDistance(from)), target);
  }

  /**
   * The angle by which the part turns over an edge before another place of it meets the bed.
   * @param {Edge} edge
   */
  #lies(edge) {
    let least = Math.PI;
    const slack = this.stage.size / 200;
    for (let i = 0; i < this.positions.length; i += 3) {
      const beyond =
        edge.normal.x * this.positions[i] + edge.normal.y * this.positions[i + 1] - edge.offset;
      const height = this.positions[i + 2];
      if (beyond * beyond + height * height > slack * slack && height > slack / 4) {
        least = Math.min(least, Math.atan2(height, beyond));
      }
    }
    return least;
  }

  /** @param {boolean} seen */
  show(seen) {
    this.figure.visible = seen;
    this.plumbs.visible = seen;
    this.stage.draw();
  }

  dispose() {
    cancelAnimationFrame(this.#animation);
    this.figure.removeFromParent();
    this.plumbs.removeFromParent();
    this.stage.part.position.set(0, 0, 0);
    this.stage.part.quaternion.identity();
    this.stage.bed.quaternion.identity();
  }
}

/**
 * @param {number[][]} polygon
 * @returns {Edge[]}
 */
function edgesOf(polygon) {
  return polygon.map(([x, y], i) => {
    const [to_x, to_y] = polygon[(i + 1) % polygon.length];
    const normal = new Vector2(to_y - y, x - to_x).normalize();
    const from = new Vector2(x, y);
    return { from, to: new Vector2(to_x, to_y), normal, offset: normal.dot(from) };
  });
}
