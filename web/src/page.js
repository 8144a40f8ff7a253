/**
 * What the page's own data holds; printprep/page/view.py writes it.
 *
 * @typedef {object} Entry one mesh in the page's bytes
 * @property {string} name
 * @property {number} vertices
 * @property {number} triangles
 * @property {number} bytes
 * @property {boolean} thickness
 * @property {{name: string, triangles: number}[]} layers
 *
 * @typedef {object} Directory
 * @property {number[]} origin mm
 * @property {number} step mm
 * @property {number} thicknessStep mm
 * @property {Entry[]} meshes
 *
 * @typedef {object} Balance
 * @property {number[][]} polygon support polygon, counter-clockwise, mm
 * @property {number[]} centre centre of mass, mm
 * @property {number[] | null} centreBefore that of the solid model
 * @property {number | null} tiltDeg
 * @property {number | null} weakestEdge
 * @property {number | null} weakestAzimuthDeg
 * @property {number} leanDeg at which it should stand
 * @property {number | null} leanAzimuthDeg
 *
 * @typedef {object} View
 * @property {Directory} directory
 * @property {number} wallMm
 * @property {number} thickestMm thickness is measured up to this
 * @property {boolean} hollowed
 * @property {Balance | null} balance
 * @property {{at: number[] | null, severity: string, rule: string}[]} findings
 * @property {{rotation: number[], tiltDeg: number}[]} poses
 * @property {number[]} low corner of the part's bounds, mm
 * @property {number[]} high
 */

/** @returns {{view: View, geometry: string}} */
export function readPage(root = document) {
  const view = /** @type {View} */ (JSON.parse(text(root, "view-data")));
  return { view, geometry: text(root, "view-geometry") };
}

/**
 * @param {Document} root
 * @param {string} id
 */
function text(root, id) {
  return element(id, root).textContent ?? "";
}

/**
 * @param {string} id
 * @param {Document} root
 * @returns {HTMLElement}
 */
export function element(id, root = document) {
  const found = root.getElementById(id);
  if (found === null) {
    throw new Error(`the page has no #${id}`);
  }
  return found;
}

/**
 * @param {string} id
 * @returns {HTMLInputElement}
 */
export function input(id) {
  return /** @type {HTMLInputElement} */ (element(id));
}

/** @param {string} message */
export function say(message) {
  element("live").textContent = message;
}

/**
 * A number with as many digits as a person reads.
 * @param {number} value
 * @param {number} decimals
 */
export function plain(value, decimals) {
  return (Math.round(value * 10 ** decimals) / 10 ** decimals + 0).toFixed(decimals);
}
