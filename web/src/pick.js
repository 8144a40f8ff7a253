/**
 * The place under the pointer: where on the part it is, and how thick the wall is there.
 */
import { Raycaster, Vector2 } from "three";

/**
 * @typedef {object} Hit
 * @property {import("three").Vector3} place in the part's coordinates
 * @property {number} thickness mm, NaN where none was measured
 * @property {string} layer
 */

const caster = new Raycaster();

/**
 * @param {import("./stage.js").Stage} stage
 * @param {import("./layers.js").Layers} layers
 * @param {import("./section.js").Section} section
 * @param {Vector2} pointer from −1 to 1
 * @returns {Hit | null}
 */
export function pick(stage, layers, section, pointer) {
  caster.setFromCamera(pointer, stage.camera);
  return along(stage, layers, section, caster.ray.origin, caster.ray.direction);
}

/**
 * The first triangle of the part that a ray meets, of those that are seen.
 * @param {import("./stage.js").Stage} stage
 * @param {import("./layers.js").Layers} layers
 * @param {import("./section.js").Section} section
 * @param {import("three").Vector3} origin in the world
 * @param {import("three").Vector3} direction in the world
 * @returns {Hit | null}
 */
export function along(stage, layers, section, origin, direction) {
  const { mesh } = layers.solids[0];
  const inverse = stage.part.matrixWorld.clone().invert();
  const o = origin.clone().applyMatrix4(inverse);
  const d = direction.clone().transformDirection(inverse);
  let best = Infinity;
  /** @type {Hit | null} */
  let hit = null;
  for (const layer of mesh.layers) {
    if (!layers.shown(layer.name) || (layer.name === "outside" && layers.clear > 0.5)) {
      continue;
    }
    for (let t = layer.start; t < layer.start + layer.count; t += 1) {
      const found = cross(mesh, t, o, d, best);
      if (found !== null) {
        const place = o.clone().addScaledVector(d, found.far);
        if (!section.removes(stage.part.localToWorld(place.clone()))) {
          best = found.far;
          hit = { place, thickness: thicknessAt(mesh, t, found), layer: layer.name };
        }
      }
    }
  }
  return hit;
}

/**
 * Where a ray crosses triangle t, nearer than `before` (Möller and Trumbore, 1997).
 * @param {import("./decode.js").Mesh} mesh
 * @param {number} t
 * @param {import("three").Vector3} o
 * @param {import("three").Vector3} d
 * @param {number} before
 */
function cross(mesh, t, o, d, before) {
  const { positions: p, index } = mesh;
  const [a, b, c] = [3 * index[3 * t], 3 * index[3 * t + 1], 3 * index[3 * t + 2]];
  const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  const [px, py, pz] = [d.y * vz - d.z * vy, d.z * vx - d.x * vz, d.x * vy - d.y * vx];
  const det = ux * px + uy * py + uz * pz;
  if (Math.abs(det) < 1e-12) {
    return null;
  }
  const [tx, ty, tz] = [o.x - p[a], o.y - p[a + 1], o.z - p[a + 2]];
  const u = (tx * px + ty * py + tz * pz) / det;
  if (u < 0 || u > 1) {
    return null;
  }
  const [qx, qy, qz] = [ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux];
  const v = (d.x * qx + d.y * qy + d.z * qz) / det;
  if (v < 0 || u + v > 1) {
    return null;
  }
  const far = (vx * qx + vy * qy + vz * qz) / det;
  return far > 1e-6 && far < before ? { far, u, v } : null;
}

/**
 * @param {import("./decode.js").Mesh} mesh
 * @param {number} t
 * @param {{u: number, v: number}} at
 */
function thicknessAt(mesh, t, { u, v }) {
  if (mesh.thickness === null) {
    return NaN;
  }
  const [a, b, c] = [0, 1, 2].map((corner) => mesh.index[3 * t + corner]);
  const { thickness } = mesh;
  return (1 - u - v) * thickness[a] + u * thickness[b] + v * thickness[c];
}

/**
 * A pointer's place in the viewer, from −1 to 1.
 * @param {HTMLElement} canvas
 * @param {MouseEvent} event
 */
export function pointerOf(canvas, event) {
  const box = canvas.getBoundingClientRect();
  return new Vector2(
    ((event.clientX - box.left) / box.width) * 2 - 1,
    1 - ((event.clientY - box.top) / box.height) * 2,
  );
}
