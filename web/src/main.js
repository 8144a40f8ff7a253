/**
 * The page comes alive: it reads its own data and shows the part.
 */
import { adopt, openSection, placeHandle, wireControls } from "./controls.js";
import { forget, placeMarker, wireFindings } from "./findings.js";
import { wireKeyboard } from "./keyboard.js";
import { element, readPage, say } from "./page.js";
import { wireServe } from "./serve.js";
import { LOOKS, Viewer } from "./viewer.js";

async function main() {
  const canvas = /** @type {HTMLCanvasElement} */ (element("canvas"));
  const { view, geometry } = readPage();
  let viewer = await Viewer.open(canvas, view, geometry);
  const current = () => viewer;
  wireControls(current);
  wireFindings(current);
  wireKeyboard(current);
  wireTheme(current);
  wirePrint(current);
  wireServe(async (next, bytes) => {
    forget();
    const before = viewer.view.hollowed;
    viewer = await viewer.follow(next, bytes);
    enter(viewer);
    if (next.hollowed && !before) {
      reveal(viewer);
    }
  });
  viewer.stage.look(LOOKS.home, true);
  enter(viewer);
  if (view.hollowed) {
    reveal(viewer);
  }
  viewer.stage.now();
  document.documentElement.dataset.ready = "true";
  performance.mark("first-picture");
}

/**
 * Opens a hollow part along its narrow side, and looks into it.
 * @param {Viewer} viewer
 */
function reveal(viewer) {
  const { low, high } = viewer.stage;
  const axis = high.x - low.x < high.y - low.y ? "x" : "y";
  viewer.stage.look(axis === "x" ? LOOKS.side : LOOKS.home, true);
  openSection(viewer, axis);
}

/** @param {Viewer} viewer */
function enter(viewer) {
  viewer.stage.beforeDraw.push(
    () => placeHandle(viewer),
    () => placeMarker(viewer),
  );
  adopt(viewer);
}

/** @param {() => Viewer} current */
function wireTheme(current) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    current().balance?.recolour();
    current().bed.recolour();
    current().stage.draw();
  });
}

/**
 * Paper gets a still picture: a canvas may print empty.
 * @param {() => Viewer} current
 */
function wirePrint(current) {
  const still = /** @type {HTMLImageElement} */ (element("still"));
  addEventListener("beforeprint", () => {
    current().stage.now();
    still.src = /** @type {HTMLCanvasElement} */ (element("canvas")).toDataURL("image/png");
  });
}

main().catch((/** @type {unknown} */ error) => {
  element("viewer").classList.add("failed");
  const reason = error instanceof Error ? error.message : String(error);
  element("failure").textContent = `This browser cannot show the part in three dimensions (${reason}).`;
  say("This browser cannot show the part in three dimensions. All figures are in the text.");
  document.documentElement.dataset.ready = "failed";
});
