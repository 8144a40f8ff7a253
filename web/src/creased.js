/**
 * Smooth where the surface is round, sharp where it has an edge.
 */
import { BufferAttribute, BufferGeometry } from "three";

const CREASE = Math.cos((38 * Math.PI) / 180);
const MOST_AROUND = 96; // a fan with more triangles around a vertex is a flat disc
const SLIVER = 2e-3; // a triangle with less of its longest edge's square has no normal of its own

/**
 * The mesh with its own three corners for every triangle.
 * @param {import("./decode.js").Mesh} mesh
 * @returns {BufferGeometry}
 */
export function creased(mesh) {
  const { positions, index } = mesh;
  const unit = new Float32Array(index.length); // normals of triangles
  const area = new Float32Array(index.length / 3); // 0 for slivers
  faceNormals(positions, index, unit, area);
  const around = facesAround(positions.length / 3, index);
  const corners = new Float32Array(3 * index.length);
  const normals = new Float32Array(3 * index.length);
  for (let corner = 0; corner < index.length; corner += 1) {
    const vertex = index[corner];
    corners.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * corner);
    const face = Math.floor(corner / 3);
    normals.set(cornerNormal(face, vertex, unit, area, around), 3 * corner);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  geometry.computeBoundingSphere();
  return geometry;
}

/**
 * @param {Float32Array} positions
 * @param {Uint32Array} index
 * @param {Float32Array} unit
 * @param {Float32Array} area
 */
function faceNormals(positions, index, unit, area) {
  for (let face = 0; face < area.length; face += 1) {
    const [a, b, c] = [3 * index[3 * face], 3 * index[3 * face + 1], 3 * index[3 * face + 2]];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    const length = Math.hypot(nx, ny, nz) || 1;
    const edge = Math.max(
      ux * ux + uy * uy + uz * uz,
      vx * vx + vy * vy + vz * vz,
      (ux - vx) ** 2 + (uy - vy) ** 2 + (uz - vz) ** 2,
    );
    unit[3 * face] = nx / length;
    unit[3 * face + 1] = ny / length;
    unit[3 * face + 2] = nz / length;
    area[face] = length < SLIVER * edge ? 0 : length;
  }
}

/**
 * The faces around every vertex, one list after another.
 * @param {number} count
 * @param {Uint32Array} index
 */
function facesAround(count, index) {
  const start = new Uint32Array(count + 1);
  for (const vertex of index) {
    start[vertex + 1] += 1;
  }
  for (let i = 0; i < count; i += 1) {
    start[i + 1] += start[i];
  }
  const next = start.slice();
  const faces = new Uint32Array(index.length);
  for (let corner = 0; corner < index.length; corner += 1) {
    const vertex = index[corner];
    faces[next[vertex]] = Math.floor(corner / 3);
    next[vertex] += 1;
  }
  return { start, faces };
}

const sum = new Float32Array(3);

/**
 * @param {number} face
 * @param {number} vertex
 * @param {Float32Array} unit
 * @param {Float32Array} area
 * @param {{start: Uint32Array, faces: Uint32Array}} around
 */
function cornerNormal(face, vertex, unit, area, around) {
  const [x, y, z] = [unit[3 * face], unit[3 * face + 1], unit[3 * face + 2]];
  const from = around.start[vertex];
  const to = around.start[vertex + 1];
  sum[0] = x;
  sum[1] = y;
  sum[2] = z;
  if (to - from > MOST_AROUND) {
    return sum;
  }
  sum.fill(0);
  for (let i = from; i < to; i += 1) {
    const other = around.faces[i];
    const [ox, oy, oz] = [unit[3 * other], unit[3 * other + 1], unit[3 * other + 2]];
    if (area[face] === 0 || x * ox + y * oy + z * oz >= CREASE) {
      sum[0] += area[other] * ox;
      sum[1] += area[other] * oy;
      sum[2] += area[other] * oz;
    }
  }
  const length = Math.hypot(sum[0], sum[1], sum[2]);
  if (length === 0) {
    sum[0] = x;
    sum[1] = y;
    sum[2] = z;
    return sum;
  }
  sum[0] /= length;
  sum[1] /= length;
  sum[2] /= length;
  return sum;
}
