/**
 * Reads the meshes of a page: the counterpart of printprep/page/encode.py.
 */

/**
 * @typedef {object} Mesh
 * @property {string} name
 * @property {Float32Array} positions three a vertex, mm
 * @property {Uint32Array} index three a triangle, counter-clockwise seen from outside
 * @property {Float32Array | null} thickness one a vertex, mm, NaN where none was measured
 * @property {{name: string, start: number, count: number}[]} layers ranges of triangles
 */

const UNMEASURED = 65535;

/**
 * @param {import("./page.js").Directory} directory
 * @param {string} text base64
 * @returns {Promise<Mesh[]>}
 */
export async function decode(directory, text) {
  const bytes = await inflate(fromBase64(text));
  let at = 0;
  return directory.meshes.map((entry) => {
    const part = bytes.subarray(at, at + entry.bytes);
    at += entry.bytes;
    return mesh(directory, entry, part);
  });
}

/**
 * @param {import("./page.js").Directory} directory
 * @param {import("./page.js").Entry} entry
 * @param {Uint8Array} bytes
 * @returns {Mesh}
 */
function mesh(directory, entry, bytes) {
  const n = entry.vertices;
  const positions = new Float32Array(3 * n);
  let at = 0;
  for (let axis = 0; axis < 3; axis += 1) {
    const steps = differences(bytes, at, n);
    at += 3 * n;
    for (let i = 0; i < n; i += 1) {
      positions[3 * i + axis] = directory.origin[axis] + directory.step * steps[i];
    }
  }
  /** @type {Float32Array | null} */
  let thickness = null;
  if (entry.thickness) {
    const steps = differences(bytes, at, n);
    at += 3 * n;
    thickness = Float32Array.from(steps, (step) =>
      step === UNMEASURED ? NaN : step * directory.thicknessStep,
    );
  }
  const index = triangles(bytes, at, entry.triangles);
  let start = 0;
  const layers = entry.layers.map(({ name, triangles: count }) => {
    const layer = { name, start, count };
    start += count;
    return layer;
  });
  return { name: entry.name, positions, index, thickness, layers };
}

/**
 * The numbers of n zigzag differences, stored as low, middle and high bytes.
 * @param {Uint8Array} bytes
 * @param {number} at
 * @param {number} n
 */
function differences(bytes, at, n) {
  const values = new Int32Array(n);
  let value = 0;
  for (let i = 0; i < n; i += 1) {
    const zigzag = bytes[at + i] | (bytes[at + n + i] << 8) | (bytes[at + 2 * n + i] << 16);
    value += unzigzag(zigzag);
    values[i] = value;
  }
  return values;
}

/**
 * @param {Uint8Array} bytes
 * @param {number} at
 * @param {number} count
 */
function triangles(bytes, at, count) {
  const index = new Uint32Array(3 * count);
  let place = at;
  const next = () => {
    let value = 0;
    let shift = 0;
    let byte;
    do {
      byte = bytes[place];
      place += 1;
      value |= (byte & 127) << shift;
      shift += 7;
    } while (byte & 128);
    return unzigzag(value);
  };
  let first = 0;
  for (let i = 0; i < 3 * count; i += 3) {
    first += next();
    index[i] = first;
    index[i + 1] = first + next();
    index[i + 2] = first + next();
  }
  return index;
}

/** @param {number} value */
function unzigzag(value) {
  return (value >>> 1) ^ -(value & 1);
}

/** @param {string} text */
function fromBase64(text) {
  const packed = atob(text.trim());
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; i += 1) {
    bytes[i] = packed.charCodeAt(i);
  }
  return bytes;
}

/** @param {Uint8Array<ArrayBuffer>} packed */
async function inflate(packed) {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
