/**
 * Findings and poses in the text: a click flies there.
 */
import { Vector3 } from "three";
import { openSection } from "./controls.js";
import { element, say } from "./page.js";
import { along } from "./pick.js";

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
  const out = place.clone().sub(stage.middle);
  out.z = Math.max(out.z, 0.15 * stage.size);
  if (Math.hypot(out.x, out.y) < 0.05 * stage.size) {
    out.set(0.3, -0.8, 0.35);
  }
  out.normalize();
  const eye = place.clone().addScaledVector(out, 0.62 * stage.size);
  const toward = place.clone().sub(eye).normalize();
  const hit = along(stage, viewer.layers, section, eye, toward);
  const deep = hit !== null && hit.place.distanceTo(eye) < place.distanceTo(eye) - 0.01 * stage.size;
  if (deep || section.removes(stage.part.localToWorld(place.clone()))) {
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
