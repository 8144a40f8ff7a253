/**
 * Findings and poses in the text: a click flies there.
 */
import { Vector3 } from "three";
import { openSection } from "./controls.js";
import { element, say } from "./page.js";
import { along } from "./pick.js";

const FAR = 0.75; // of the part's diagonal, from the eye to the place

/** @type {Vector3 | null} */
let marked = null;

/** @param {() => import("./viewer.js").Viewer} current */
export function wireFindings(current) {
  document.addEventListener("click", (event) => {
    const button = /** @type {Element} */ (event.target).closest("[data-finding], [data-pose]");
    if (button === null) {
      return;
    }
    const viewer = current();
    const finding = button.getAttribute("data-finding");
    if (finding !== null) {
      fly(viewer, Number(finding));
    } else {
      pose(viewer, button);
    }
  });
}

/**
 * @param {import("./viewer.js").Viewer} viewer
 * @param {number} number
 */
function fly(viewer, number) {
  const finding = viewer.view.findings[number];
  if (finding.at === null) {
    return;
  }
  const { stage, section } = viewer;
  const place = new Vector3(...finding.at);
  const removed = section.removes(stage.part.localToWorld(place.clone()));
  if (removed) {
    openSection(viewer, "off");
  }
  const ways = waysOut(place, stage);
  const seen = ways.find((way) => isSeen(viewer, place, way));
  const out = seen ?? ways[0];
  const eye = place.clone().addScaledVector(out, FAR * stage.size);
  if (seen === undefined) {
    stage.camera.position.copy(eye);
    const across = Math.abs(out.x) > Math.abs(out.y) ? "x" : "y";
    openSection(viewer, across, place);
  }
  marked = place;
  element("marker").dataset.severity = finding.severity;
  stage.fly(eye, place);
  say(`The view shows the place of the finding ${finding.rule}.`);
  element("viewer").scrollIntoView({ block: "nearest", behavior: "smooth" });
}

/**
 * Directions from a place to an eye, the best first: away from the middle, then around and below.
 * @param {Vector3} place
 * @param {import("./stage.js").Stage} stage
 */
function waysOut(place, stage) {
  const away = place.clone().sub(stage.middle);
  const start = Math.hypot(away.x, away.y) < 0.03 * stage.size ? -1.05 : Math.atan2(away.y, away.x);
  const steep = away.z / (Math.hypot(away.x, away.y, away.z) || 1);
  const first = Math.min(Math.max(steep, -0.3), 0.6);
  const ways = [];
  for (const rise of [Math.max(first, 0.15), 0.35, first, -0.25, 0.9, -0.7]) {
    for (const turn of [0, 0.6, -0.6, 1.2, -1.2, 2.2, -2.2, Math.PI]) {
      const [x, y] = [Math.cos(start + turn), Math.sin(start + turn)];
      ways.push(new Vector3(x, y, rise).normalize());
    }
  }
  return ways;
}

/**
 * Whether nothing is between a place and an eye in that direction.
 * @param {import("./viewer.js").Viewer} viewer
 * @param {Vector3} place
 * @param {Vector3} way
 */
function isSeen(viewer, place, way) {
  const { stage, layers, section } = viewer;
  const eye = place.clone().addScaledVector(way, FAR * stage.size);
  const hit = along(stage, layers, section, stage.part.localToWorld(eye.clone()), way.clone().negate());
  return hit === null || hit.place.distanceTo(place) < 0.012 * stage.size;
}

/**
 * @param {import("./viewer.js").Viewer} viewer
 * @param {Element} button
 */
function pose(viewer, button) {
  const pressed = button.getAttribute("aria-pressed") === "true";
  for (const other of document.querySelectorAll("[data-pose]")) {
    other.setAttribute("aria-pressed", "false");
  }
  button.setAttribute("aria-pressed", String(!pressed));
  const number = Number(button.getAttribute("data-pose"));
  viewer.pose(pressed ? null : viewer.view.poses[number].rotation);
  say(pressed ? "The part stands as in the file." : `The part is shown in pose ${number + 1}.`);
}

export function forget() {
  marked = null;
}

/**
 * Keeps the marker over its place.
 * @param {import("./viewer.js").Viewer} viewer
 */
export function placeMarker(viewer) {
  const marker = element("marker");
  const world = marked === null ? null : viewer.stage.part.localToWorld(marked.clone());
  const at = world === null ? null : viewer.stage.project(world);
  marker.hidden = at === null;
  if (at !== null) {
    marker.style.left = `${at.x}px`;
    marker.style.top = `${at.y}px`;
  }
}
