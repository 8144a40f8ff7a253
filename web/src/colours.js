/**
 * The colours of layers and of wall thickness; those of the page come from its style sheet.
 */
import { Color } from "three";

/** @type {Record<string, string>} */
export const LAYER_COLOURS = {
  outside: "#d8d3ca",
  base: "#7d8794",
  cavity: "#5b9bd5",
  vaults: "#2ca58d",
  ballast: "#9a6fc4",
  infill: "#f3cf9b",
  drains: "#e0569a",
  plugs: "#e6c229",
  wall: "#f28a2e", // the cut through the part's own material
};

/**
 * Stops of the thickness scale, as shares of its top; the wall of the profile is at WALL_SHARE.
 * Dark red where it is thinner, then amber at the wall, then through green to blue: told apart by
 * lightness too.
 * @type {[number, string][]}
 */
export const THICKNESS_STOPS = [
  [0, "#6d0f1c"],
  [0.2, "#c1272d"],
  [0.33, "#f6a623"],
  [0.45, "#f7e38a"],
  [0.65, "#5cc0a6"],
  [1, "#24539c"],
];
export const WALL_SHARE = 1 / 3;

const stops = THICKNESS_STOPS.map(
  ([at, hex]) => /** @type {[number, Color]} */ ([at, new Color(hex)]),
);
const unmeasured = new Color("#9aa0a6");

/**
 * @param {number} thickness mm, NaN where none was measured
 * @param {number} top mm, of the scale
 * @param {Color} out
 */
export function thicknessColour(thickness, top, out) {
  if (Number.isNaN(thickness)) {
    return out.copy(unmeasured);
  }
  const share = Math.min(Math.max(thickness / top, 0), 1);
  for (let i = 1; i < stops.length; i += 1) {
    const [high, colour] = stops[i];
    if (share <= high) {
      const [low, before] = stops[i - 1];
      return out.copy(before).lerp(colour, (share - low) / (high - low));
    }
  }
  return out.copy(stops[stops.length - 1][1]);
}

/**
 * A colour of the style sheet.
 * @param {string} name
 */
export function themed(name) {
  const value = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return new Color(value);
}
