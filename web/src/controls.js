/**
 * The controls under the picture. They act on the viewer that is current.
 */
import { Vector2 } from "three";
import { LAYER_COLOURS } from "./colours.js";
import { element, input, plain, say } from "./page.js";
import { pick, pointerOf } from "./pick.js";
import { LOOKS } from "./viewer.js";

/** @typedef {() => import("./viewer.js").Viewer} Current */

/** @type {Record<string, string>} */
const LAYER_NAMES = {
  outside: "Outside",
  base: "Base",
  cavity: "Cavities",
  vaults: "Vaults",
  ballast: "Ballast",
  infill: "Sparse infill",
  drains: "Drain holes",
  plugs: "Plugs",
};

/** @param {Current} current */
export function wireControls(current) {
  wireLooks(current);
  wireLayers(current);
  wireSection(current);
  wireLean(current);
  wireReadout(current);
}

/**
 * Puts the controls into the state of a new viewer, or the viewer into that of the controls.
 * @param {import("./viewer.js").Viewer} viewer
 */
export function adopt(viewer) {
  listLayers(viewer);
  viewer.layers.setClear(Number(input("clear").value) / 100);
  viewer.layers.setThickness(input("by-thickness").checked);
  element("scale").hidden = !input("by-thickness").checked;
  element("lean-panel").hidden = viewer.balance === null;
  const lean = viewer.balance;
  if (lean !== null) {
    const azimuth = Math.round(lean.azimuth);
    input("azimuth").value = String(azimuth > 180 ? azimuth - 360 : azimuth);
    input("lean").value = "0";
    showLean(viewer);
  }
  const axis = /** @type {HTMLInputElement | null} */ (
    document.querySelector("input[name=axis]:checked")
  );
  openSection(viewer, /** @type {import("./section.js").Axis} */ (axis?.value ?? "off"));
}

/** @param {Current} current */
function wireLooks(current) {
  for (const button of document.querySelectorAll("[data-look]")) {
    button.addEventListener("click", () => {
      const name = /** @type {keyof typeof LOOKS} */ (button.getAttribute("data-look"));
      current().stage.look(LOOKS[name]);
    });
  }
}

/** @param {Current} current */
function wireLayers(current) {
  input("clear").addEventListener("input", () => {
    const clear = Number(input("clear").value);
    element("clear-out").textContent = `${clear} %`;
    current().layers.setClear(clear / 100);
  });
  for (const id of ["by-layer", "by-thickness"]) {
    input(id).addEventListener("change", () => {
      const on = input("by-thickness").checked;
      current().layers.setThickness(on);
      element("scale").hidden = !on;
      say(on ? "Colours show wall thickness." : "Colours show layers.");
    });
  }
}

/** @param {import("./viewer.js").Viewer} viewer */
function listLayers(viewer) {
  const list = element("layer-list");
  list.replaceChildren();
  for (const name of viewer.layers.names) {
    const label = document.createElement("label");
    label.className = "chip";
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.dataset.layer = name;
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = LAYER_COLOURS[name];
    label.append(box, swatch, LAYER_NAMES[name]);
    box.addEventListener("change", () => {
      viewer.layers.show(name, box.checked);
      viewer.section.hide(name, !box.checked);
    });
    list.append(label);
  }
}

/** @param {Current} current */
function wireSection(current) {
  for (const radio of document.querySelectorAll("input[name=axis]")) {
    radio.addEventListener("change", () => {
      const axis = /** @type {import("./section.js").Axis} */ (
        /** @type {HTMLInputElement} */ (radio).value
      );
      openSection(current(), axis);
    });
  }
  input("cut").addEventListener("input", () => {
    current().section.moveTo(Number(input("cut").value));
    showSection(current());
  });
  element("flip").addEventListener("click", () => current().section.flip());
  wireHandle(current);
}

/**
 * Opens the part along an axis, in the middle or at a place.
 * @param {import("./viewer.js").Viewer} viewer
 * @param {import("./section.js").Axis} axis
 * @param {import("three").Vector3 | null} through
 */
export function openSection(viewer, axis, through = null) {
  const { section } = viewer;
  const before = section.axis;
  section.setAxis(axis);
  const radio = /** @type {HTMLInputElement | null} */ (
    document.querySelector(`input[name=axis][value=${axis}]`)
  );
  if (radio !== null) {
    radio.checked = true;
  }
  if (axis !== "off") {
    const [least, most] = section.range();
    const cut = input("cut");
    cut.min = String(Math.floor(10 * least) / 10);
    cut.max = String(Math.ceil(10 * most) / 10);
    section.moveTo(through === null ? (least + most) / 2 : through.dot(section.normal));
    if (before !== axis || through !== null) {
      section.faceEye();
    }
    cut.value = String(section.at);
  }
  element("section-panel").classList.toggle("off", axis === "off");
  input("cut").disabled = axis === "off";
  /** @type {HTMLButtonElement} */ (element("flip")).disabled = axis === "off";
  showSection(viewer);
}

/** @param {import("./viewer.js").Viewer} viewer */
function showSection(viewer) {
  const { section } = viewer;
  const off = section.axis === "off";
  element("cut-out").textContent = off ? "closed" : `${plain(section.at, 1)} mm`;
  placeHandle(viewer);
}

/** @param {Current} current */
function wireHandle(current) {
  const handle = element("handle");
  /** @type {{x: number, y: number, at: number} | null} */
  let start = null;
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    start = { x: event.clientX, y: event.clientY, at: current().section.at };
    event.preventDefault();
  });
  handle.addEventListener("pointermove", (event) => {
    if (start === null) {
      return;
    }
    const viewer = current();
    const along = directionSeen(viewer);
    const length = along.length();
    if (length < 1e-6) {
      return;
    }
    const moved = new Vector2(event.clientX - start.x, event.clientY - start.y);
    viewer.section.moveTo(start.at + moved.dot(along) / (length * length));
    input("cut").value = String(viewer.section.at);
    showSection(viewer);
  });
  const end = () => {
    start = null;
  };
  handle.addEventListener("pointerup", end);
  handle.addEventListener("pointercancel", end);
}

/**
 * CSS pixels a millimetre along the section's normal; where it points at the eye, up.
 * @param {import("./viewer.js").Viewer} viewer
 */
function directionSeen(viewer) {
  const { place, normal } = viewer.section.handle();
  const from = viewer.stage.project(place);
  const to = viewer.stage.project(place.clone().add(normal));
  if (from === null || to === null) {
    return new Vector2();
  }
  const seen = new Vector2(to.x - from.x, to.y - from.y);
  return seen.length() < 0.35 ? new Vector2(0, -2) : seen;
}

/** @param {import("./viewer.js").Viewer} viewer */
export function placeHandle(viewer) {
  const handle = element("handle");
  const { beside } = viewer.section.handle();
  const at = viewer.section.axis === "off" ? null : viewer.stage.project(beside);
  handle.hidden = at === null;
  if (at !== null) {
    const along = directionSeen(viewer);
    const box = viewer.stage.canvas.getBoundingClientRect();
    handle.style.left = `${Math.min(Math.max(at.x, 28), box.width - 28)}px`;
    handle.style.top = `${Math.min(Math.max(at.y, 74), box.height - 28)}px`;
    handle.style.setProperty("--turn", `${(Math.atan2(along.y, along.x) * 180) / Math.PI}deg`);
  }
}

/** @param {Current} current */
function wireLean(current) {
  for (const id of ["lean", "azimuth"]) {
    input(id).addEventListener("input", () => showLean(current()));
  }
  input("show-balance").addEventListener("change", () => {
    current().balance?.show(input("show-balance").checked);
    element("key").hidden = !input("show-balance").checked;
  });
  element("tip-it").addEventListener("click", () => {
    const { balance } = current();
    if (balance === null) {
      return;
    }
    const azimuth = Number(input("azimuth").value);
    const most = Number(input("lean").max);
    input("lean").value = String(Math.min(balance.tipsAt(azimuth).deg + 0.5, most));
    showLean(current());
  });
  element("level").addEventListener("click", () => {
    input("lean").value = "0";
    showLean(current());
  });
}

/** @param {import("./viewer.js").Viewer} viewer */
function showLean(viewer) {
  const { balance } = viewer;
  if (balance === null) {
    return;
  }
  const lean = Number(input("lean").value);
  const azimuth = Number(input("azimuth").value);
  const stands = balance.set(lean, azimuth);
  const tips = balance.tipsAt(azimuth).deg;
  element("lean-out").textContent = `${plain(lean, 1)}°`;
  element("azimuth-out").textContent = `${plain(azimuth, 0)}°`;
  let verdict = `stands up to ${plain(tips, 1)}°`;
  if (tips < 0) {
    verdict = "falls over by itself";
  } else if (!stands) {
    verdict = `tips over at ${plain(tips, 1)}°`;
  }
  element("lean-verdict").textContent = `· ${verdict}`;
  element("lean-verdict").classList.toggle("bad", !stands);
}

/** @param {Current} current */
function wireReadout(current) {
  const canvas = element("canvas");
  const tip = element("tip");
  let waiting = false;
  canvas.addEventListener("pointermove", (event) => {
    if (waiting) {
      return;
    }
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      if (event.buttons !== 0) {
        tip.hidden = true;
        return;
      }
      read(current(), event, tip);
    });
  });
  canvas.addEventListener("click", (event) => read(current(), event, tip));
  canvas.addEventListener("pointerleave", (event) => {
    tip.hidden = event.pointerType === "mouse";
  });
}

/**
 * @param {import("./viewer.js").Viewer} viewer
 * @param {MouseEvent} event
 * @param {HTMLElement} tip
 */
function read(viewer, event, tip) {
  const canvas = element("canvas");
  const hit = pick(viewer.stage, viewer.layers, viewer.section, pointerOf(canvas, event));
  tip.hidden = hit === null;
  if (hit === null) {
    return;
  }
  const most = viewer.view.thickestMm;
  const wall =
    hit.thickness < most - 0.02
      ? `${plain(hit.thickness, 2)} mm thick`
      : `more than ${plain(most, 1)} mm thick`;
  const { x, y, z } = hit.place;
  tip.textContent = `${wall}  ·  x ${plain(x, 1)}  y ${plain(y, 1)}  z ${plain(z, 1)}`;
  const box = canvas.getBoundingClientRect();
  tip.style.left = `${Math.min(event.clientX - box.left + 14, box.width - 230)}px`;
  tip.style.top = `${Math.max(event.clientY - box.top - 34, 6)}px`;
}
